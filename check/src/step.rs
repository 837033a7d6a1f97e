//! The checks by name.

use anyhow::Result;
use clap::ValueEnum;

use crate::problem::Problem;
use crate::workspace::Workspace;
use crate::{crates, external, files, idle_tests, sizes, unsafe_code};

/// A check. Those that take long come last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Step {
    /// Crates depend on what the table allows
    Crates,
    /// No files of a crate depend on each other in a circle
    Files,
    /// Files of more than 400 lines have a reason in their head
    Sizes,
    /// Unsafe code is where it may be
    Unsafe,
    /// No test is where cargo runs none
    Tests,
    /// scenes/generate.py writes what is there
    Freshness,
    /// cargo fmt changes nothing
    Format,
    /// clippy has no warning
    Lints,
    /// rustdoc has no warning
    Documentation,
}

impl Step {
    pub(crate) fn name(self) -> String {
        self.value().get_name().to_owned()
    }

    pub(crate) fn description(self) -> String {
        let help = self.value().get_help().map(ToString::to_string);
        help.expect("each step has a description")
    }

    fn value(self) -> clap::builder::PossibleValue {
        self.to_possible_value().expect("no step is hidden")
    }

    pub(crate) fn problems(self, workspace: &Workspace) -> Result<Vec<Problem>> {
        match self {
            Self::Crates => Ok(crates::problems(workspace, crates::TABLE)),
            Self::Files => files::problems(workspace),
            Self::Sizes => sizes::problems(workspace),
            Self::Unsafe => unsafe_code::problems(workspace),
            Self::Tests => idle_tests::problems(workspace),
            Self::Freshness => external::freshness(&workspace.root),
            Self::Format => external::format(&workspace.root),
            Self::Lints => external::lints(&workspace.root),
            Self::Documentation => external::documentation(&workspace.root),
        }
    }
}
