//! What has been measured, in a file that is only added to: a study that was stopped goes on where it was.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use serde_json::{Value, json};

/// Entries by name, one JSON object a line. Those of studies with other settings stay in the file and are left alone.
pub struct Journal {
    file: File,
    study: String,
    entries: BTreeMap<String, Value>,
}

impl Journal {
    /// The journal in this file, which is made if it is not there, of the study that this name stands for: scene, settings and
    /// reference.
    ///
    /// # Errors
    /// If the file cannot be read or written.
    pub fn open(path: &Path, study: String) -> Result<Self> {
        let open = OpenOptions::new().create(true).append(true).open(path);
        let mut file = open.with_context(|| format!("opening {}", path.display()))?;
        let text = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
        let text = String::from_utf8_lossy(&text);
        // A program that was killed leaves half a line, which is no JSON.
        if !text.is_empty() && !text.ends_with('\n') {
            writeln!(file)?;
        }
        let lines = text
            .lines()
            .filter_map(|line| serde_json::from_str(line).ok());
        let entries = lines.filter_map(|line: Value| {
            let is_ours = line["study"].as_str() == Some(&study);
            let name = line["entry"].as_str()?.to_owned();
            is_ours.then(|| (name, line["value"].clone()))
        });
        let entries = entries.collect();
        Ok(Self {
            file,
            study,
            entries,
        })
    }

    /// The entry with this name; of several, the last.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.entries.get(name)
    }

    /// All entries of the study.
    pub fn entries(&self) -> impl Iterator<Item = &Value> {
        self.entries.values()
    }

    /// Adds an entry.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn add(&mut self, name: &str, value: Value) -> Result<()> {
        let line = json!({ "study": self.study, "entry": name, "value": value });
        // One call, so that half a line is rare.
        self.file
            .write_all(format!("{line}\n").as_bytes())
            .and_then(|()| self.file.flush())
            .context("writing down what was measured")?;
        self.entries.insert(name.to_owned(), value);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_survive_and_half_lines_do_no_harm() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal.jsonl");
        let open = |study: &str| Journal::open(&path, study.to_owned()).unwrap();
        open("a").add("x", json!([1.5, 2])).unwrap();
        open("b").add("x", json!(7)).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, format!("{text}{}", &text[..20])).unwrap();
        open("a").add("y", json!(3)).unwrap();
        let journal = open("a");
        assert_eq!(journal.get("x"), Some(&json!([1.5, 2])));
        assert_eq!(journal.get("y"), Some(&json!(3)));
        assert_eq!(open("b").get("x"), Some(&json!(7)));
        assert_eq!(open("c").get("x"), None);
    }
}
