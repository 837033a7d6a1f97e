//! A texture's statement in an MTL file: options, and a file.

use std::collections::BTreeSet;

use super::lines::split_word;
use super::numbers;
use crate::desc::Wrap;
use crate::import::images::ScalarSource;

/// A texture's file and the options before it.
#[derive(Debug, PartialEq)]
pub(super) struct MapStatement {
    /// File name as written; may have spaces.
    pub(super) file: String,
    /// `-s`, along u and v.
    pub(super) scale: [f32; 2],
    /// `-o`, along u and v.
    pub(super) offset: [f32; 2],
    /// `-clamp`: the image is there once, as a stamp on an envelope, and around it the material is what it is without the image.
    pub(super) wrap: Wrap,
    /// `-imfchan`: what a scalar map is made of, if it says so.
    pub(super) source: Option<ScalarSource>,
    /// `-mm`: what is added to all values.
    pub(super) base: f32,
    /// `-mm`: a factor on them.
    pub(super) gain: f32,
    /// `-bm`, if it is there.
    pub(super) bump_scale: Option<f32>,
    /// Names of the other options, without the dash.
    pub(super) others: BTreeSet<String>,
}

impl MapStatement {
    /// Reads `-option argument… file name`; options may be written in any case.
    pub(super) fn parse(statement: &str) -> Self {
        let mut map = Self {
            file: String::new(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            wrap: Wrap::Repeat,
            source: None,
            base: 0.0,
            gain: 1.0,
            bump_scale: None,
            others: BTreeSet::new(),
        };
        let mut rest = statement.trim();
        while let Some((name, arguments, remainder)) = split_option(rest) {
            map.apply(&name, &arguments);
            rest = remainder;
        }
        // Some programs write options behind the name.
        while let Some((file, option)) = rest
            .rsplit_once(" -")
            .map(|(file, _)| rest.split_at(file.len()))
            && let Some((name, arguments, "")) = split_option(option.trim())
            && arguments.iter().all(|argument| is_value(argument))
        {
            map.apply(&name, &arguments);
            rest = file.trim();
        }
        map.file = rest.trim().to_owned();
        map
    }

    fn apply(&mut self, name: &str, arguments: &[&str]) {
        match name {
            "s" => self.scale = [0, 1].map(|index| number(arguments, index, 1.0)),
            "o" => self.offset = [0, 1].map(|index| number(arguments, index, 0.0)),
            "clamp" => {
                self.wrap = match is_on(arguments) {
                    true => Wrap::WhiteBorder,
                    false => Wrap::Repeat,
                }
            }
            "imfchan" => {
                self.source = match arguments[0].to_ascii_lowercase().as_str() {
                    "r" => Some(ScalarSource::Channel(0)),
                    "g" => Some(ScalarSource::Channel(1)),
                    "b" => Some(ScalarSource::Channel(2)),
                    "m" => Some(ScalarSource::Channel(3)),
                    "l" => Some(ScalarSource::Luminance),
                    // Depth, which no image has.
                    _ => {
                        self.others.insert(name.to_owned());
                        None
                    }
                }
            }
            "mm" => {
                self.base = number(arguments, 0, 0.0);
                self.gain = number(arguments, 1, 1.0);
            }
            "bm" => self.bump_scale = Some(number(arguments, 0, 1.0)),
            // As images are filtered anyway.
            "blendu" | "blendv" if is_on(arguments) => {}
            _ => {
                self.others.insert(name.to_owned());
            }
        }
    }
}

fn is_on(arguments: &[&str]) -> bool {
    arguments[0].eq_ignore_ascii_case("on")
}

/// The name of an option in lower case, its arguments, of which there is at least one, and what follows; `None` where the
/// file's name starts.
fn split_option(text: &str) -> Option<(String, Vec<&str>, &str)> {
    let (name, mut rest) = split_word(text.strip_prefix('-')?);
    let name = name.to_ascii_lowercase();
    let (least, most) = match name.as_str() {
        "o" | "s" | "t" => (1, 3),
        "mm" => (2, 2),
        "blendu" | "blendv" | "bm" | "boost" | "cc" | "clamp" | "colorspace" | "imfchan"
        | "texres" | "type" => (1, 1),
        // Not an option: a file whose name starts with a dash.
        _ => return None,
    };
    let mut arguments = Vec::new();
    while arguments.len() < most {
        let (argument, remainder) = split_word(rest);
        // The second and third number may be missing, and the file's name comes next.
        if arguments.len() >= least && numbers::parse(argument).is_none() {
            break;
        }
        arguments.push(argument);
        rest = remainder;
    }
    Some((name, arguments, rest))
}

/// Whether a word can be an option's argument and no part of a file's name.
fn is_value(word: &str) -> bool {
    numbers::parse(word).is_some()
        || ["on", "off"].contains(&&*word.to_ascii_lowercase())
        || word.len() == 1
}

fn number(arguments: &[&str], index: usize, default: f32) -> f32 {
    arguments
        .get(index)
        .and_then(|text| numbers::parse(text))
        .unwrap_or(default)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_told_from_file_names() {
        let map = MapStatement::parse("-s 2 3 -clamp on -bm 0.5 -o 0.25 my texture 1.png");
        assert_eq!(map.file, "my texture 1.png");
        assert_eq!(map.scale, [2.0, 3.0]);
        assert_eq!(map.wrap, Wrap::WhiteBorder);
        assert_eq!(map.bump_scale, Some(0.5));
        assert_eq!(map.offset, [0.25, 0.0]);
        assert!(map.others.is_empty());
        assert_eq!(MapStatement::parse("-dash.png").file, "-dash.png");
        assert_eq!(MapStatement::parse("tex\\a b.png").file, "tex\\a b.png");
        assert_eq!(MapStatement::parse("-s").file, "");
    }

    #[test]
    fn options_may_stand_behind_the_name() {
        let map = MapStatement::parse("-s 2 2 2 a - b -c.png -bm 0.5 -clamp on");
        assert_eq!(map.file, "a - b -c.png");
        assert_eq!(
            (map.bump_scale, map.wrap, map.scale),
            (Some(0.5), Wrap::WhiteBorder, [2.0; 2])
        );
        assert_eq!(MapStatement::parse("a -s b.png").file, "a -s b.png");
    }

    #[test]
    fn the_last_of_equal_options_counts_and_unread_ones_are_named() {
        let map = MapStatement::parse("-s 2 3 -s 4 -imfchan g -imfchan m -mm 1 1 -cc on -o nan a");
        assert_eq!(
            (map.scale, map.source, map.offset),
            ([4.0, 1.0], Some(ScalarSource::Channel(3)), [0.0; 2])
        );
        assert_eq!(map.others.into_iter().collect::<Vec<_>>(), ["cc"]);
        assert_eq!((map.file.as_str(), map.base, map.gain), ("a", 1.0, 1.0));
        assert_eq!(MapStatement::parse("-mm 0 0.5 a").gain, 0.5);
        let luminance = MapStatement::parse("-imfchan l a");
        assert_eq!(luminance.source, Some(ScalarSource::Luminance));
        let depth = MapStatement::parse("-imfchan z a");
        assert_eq!((depth.source, depth.others.len()), (None, 1));
    }

    #[test]
    fn options_are_read_in_any_case() {
        let upper =
            "-S 2 3 -O 0.25 -CLAMP ON -Bm 0.5 -IMFCHAN L -Mm 0.1 0.2 -BlendU On -CC on A.png";
        let map = MapStatement::parse(upper);
        let lower = upper.replace("A.png", "").to_lowercase() + "A.png";
        assert_eq!(map, MapStatement::parse(&lower));
        assert_eq!((map.wrap, map.scale), (Wrap::WhiteBorder, [2.0, 3.0]));
        assert_eq!(map.others.into_iter().collect::<Vec<_>>(), ["cc"]);
        let behind = MapStatement::parse("a.png -BM 0.5 -Clamp On");
        assert_eq!(
            (behind.file.as_str(), behind.bump_scale),
            ("a.png", Some(0.5))
        );
        // A name is no option.
        assert_eq!(MapStatement::parse("-Dash.png").file, "-Dash.png");
    }
}
