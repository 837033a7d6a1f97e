//! A texture's statement in an MTL file: options, and a file.

use std::collections::BTreeSet;

use super::lines::split_word;
use super::numbers;
use crate::desc::Wrap;

/// A texture's file and the options before it.
#[derive(Debug, PartialEq)]
pub(super) struct MapStatement {
    /// File name as written; may have spaces.
    pub(super) file: String,
    /// `-s`, along u and v.
    pub(super) scale: [f32; 2],
    /// `-o`, along u and v.
    pub(super) offset: [f32; 2],
    /// `-clamp`.
    pub(super) wrap: Wrap,
    /// `-imfchan`: the channel of a scalar map, 0 red … 3 alpha, if it names one.
    pub(super) channel: Option<usize>,
    /// `-mm` without a base: a factor on the values.
    pub(super) gain: f32,
    /// `-bm`, if it is there.
    pub(super) bump_scale: Option<f32>,
    /// Names of the other options, without the dash.
    pub(super) others: BTreeSet<String>,
}

impl MapStatement {
    /// Reads `-option argument… file name`.
    pub(super) fn parse(statement: &str) -> Self {
        let mut map = Self {
            file: String::new(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            wrap: Wrap::Repeat,
            channel: None,
            gain: 1.0,
            bump_scale: None,
            others: BTreeSet::new(),
        };
        let mut rest = statement.trim();
        while let Some((name, arguments, remainder)) = split_option(rest) {
            map.apply(name, &arguments);
            rest = remainder;
        }
        // Some programs write options behind the name.
        while let Some((file, option)) = rest
            .rsplit_once(" -")
            .map(|(file, _)| rest.split_at(file.len()))
            && let Some((name, arguments, "")) = split_option(option.trim())
            && arguments.iter().all(|argument| is_value(argument))
        {
            map.apply(name, &arguments);
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
                self.wrap = match arguments[0] {
                    "on" => Wrap::Clamp,
                    _ => Wrap::Repeat,
                }
            }
            "imfchan" => {
                self.channel = match arguments[0] {
                    "r" => Some(0),
                    "g" => Some(1),
                    "b" => Some(2),
                    "m" => Some(3),
                    // Luminance, of images that are grey; and depth, which none has.
                    _ => None,
                }
            }
            // A base would have to be added to every texel.
            "mm" if number(arguments, 0, 1.0) == 0.0 => self.gain = number(arguments, 1, 1.0),
            "bm" => self.bump_scale = Some(number(arguments, 0, 1.0)),
            // As images are filtered anyway.
            "blendu" | "blendv" if arguments[0] == "on" => {}
            _ => {
                self.others.insert(name.to_owned());
            }
        }
    }
}

/// The name of an option, its arguments, of which there is at least one, and what follows; `None` where the
/// file's name starts.
fn split_option(text: &str) -> Option<(&str, Vec<&str>, &str)> {
    let (name, mut rest) = split_word(text.strip_prefix('-')?);
    let (least, most) = match name {
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
    numbers::parse(word).is_some() || matches!(word, "on" | "off") || word.len() == 1
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
        assert_eq!(map.wrap, Wrap::Clamp);
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
            (Some(0.5), Wrap::Clamp, [2.0; 2])
        );
        assert_eq!(MapStatement::parse("a -s b.png").file, "a -s b.png");
    }

    #[test]
    fn the_last_of_equal_options_counts_and_unread_ones_are_named() {
        let map = MapStatement::parse("-s 2 3 -s 4 -imfchan g -imfchan m -mm 1 1 -cc on -o nan a");
        assert_eq!(
            (map.scale, map.channel, map.offset),
            ([4.0, 1.0], Some(3), [0.0; 2])
        );
        assert_eq!(map.others.into_iter().collect::<Vec<_>>(), ["cc", "mm"]);
        assert_eq!(map.file, "a");
        assert_eq!(MapStatement::parse("-mm 0 0.5 a").gain, 0.5);
    }
}
