//! What an import says besides the scene: warnings, and what of the file changes nothing.

use crate::desc::{Dismissed, Warning, WarningKind};
use crate::effect::Effect;

/// More warnings than this are only counted: a hostile file can cause millions.
const MAX_WARNINGS: usize = 1000;

/// Warnings as they come up.
#[derive(Debug, Default)]
pub(super) struct Warnings {
    list: Vec<Warning>,
    omitted: usize,
    dismissed: Vec<Dismissed>,
}

impl Warnings {
    /// Records a warning, each once.
    pub(super) fn push(&mut self, place: impl Into<String>, message: impl Into<String>) {
        if self.list.len() >= MAX_WARNINGS {
            self.omitted += 1;
            return;
        }
        let warning = Warning {
            kind: WarningKind::Unfaithful,
            place: place.into(),
            message: message.into(),
        };
        if !self.list.contains(&warning) {
            self.list.push(warning);
        }
    }

    /// Records that something changes nothing, each once.
    pub(super) fn dismiss(
        &mut self,
        effect: Option<Effect>,
        place: impl Into<String>,
        reason: impl Into<String>,
    ) {
        let dismissed = Dismissed {
            effect,
            place: place.into(),
            reason: reason.into(),
        };
        if self.dismissed.len() < MAX_WARNINGS && !self.dismissed.contains(&dismissed) {
            self.dismissed.push(dismissed);
        }
    }

    /// What was dismissed, in order.
    pub(super) fn take_dismissed(&mut self) -> Vec<Dismissed> {
        std::mem::take(&mut self.dismissed)
    }

    /// All warnings, in order.
    pub(super) fn into_vec(mut self) -> Vec<Warning> {
        if self.omitted > 0 {
            let message = format!("{} more warnings are left out", self.omitted);
            self.list.push(Warning {
                kind: WarningKind::Unfaithful,
                place: "warnings".into(),
                message,
            });
        }
        self.list
    }
}
