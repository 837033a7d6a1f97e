//! The rows as tables for people.

use super::{InterfaceRow, KindRow};
use crate::report::interval;

/// A table of programs.
pub fn kind_table(rows: &[KindRow]) -> String {
    let mut text = format!(
        "{:<18} {:<10} {:>5}  {:>23}  {:>23}  {:>20}  {:>20}\n",
        "program",
        "inputs",
        "lanes",
        "ns specialized [95 %]",
        "ns interpreted [95 %]",
        "interpreted [95 %]",
        "to constants [95 %]",
    );
    for row in rows {
        text.push_str(&format!(
            "{:<18} {:<10} {:>5}  {:>23}  {:>23}  {:>20}  {:>20}\n",
            row.kind,
            row.inputs,
            row.lanes,
            interval(&row.specialized_ns, 1),
            interval(&row.interpreted_ns, 1),
            interval(&row.interpreted_over_specialized, 2),
            interval(&row.over_constants, 2),
        ));
    }
    text
}

/// A table of interfaces.
pub fn interface_table(rows: &[InterfaceRow]) -> String {
    let mut text = format!(
        "{:<10} {:<10} {:>5}  {:>23}  {:>20}\n",
        "textures", "attributes", "lanes", "ns [95 %]", "to both known [95 %]",
    );
    let word = |known| if known { "known" } else { "not known" };
    for row in rows {
        text.push_str(&format!(
            "{:<10} {:<10} {:>5}  {:>23}  {:>20}\n",
            word(row.known.textures),
            word(row.known.attributes),
            row.lanes,
            interval(&row.ns, 1),
            interval(&row.over_known, 2),
        ));
    }
    text
}
