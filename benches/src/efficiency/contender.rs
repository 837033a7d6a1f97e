//! Who renders, and the rounds in which all do in turn.

use anyhow::{Context, Result};

/// Who renders, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The renderer, whose images share a converged one.
    pub renderer: String,
    /// Its tier or variant.
    pub variant: String,
    /// Its sampler.
    pub sampler: String,
}

/// An image and what it took.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// Linear red, green and blue, row by row from the top.
    pub image: Vec<[f32; 3]>,
    /// Samples per pixel, which may be more than were asked for.
    pub samples: u32,
    /// CPU seconds of all threads for rendering alone: without the scene's file, its hierarchy, and compiling.
    pub cpu_s: f64,
}

/// A renderer with a sampler.
pub trait Contender {
    /// Who it is.
    fn label(&self) -> Label;

    /// Renders so many samples per pixel; images of different seeds are independent.
    ///
    /// # Errors
    /// If it cannot.
    fn render(&mut self, samples: u32, seed: u32) -> Result<Rendered>;
}

/// An image of a series.
#[derive(Clone, Debug)]
pub struct Run {
    /// As in [`Rendered`].
    pub image: Vec<[f32; 3]>,
    /// As in [`Rendered`].
    pub cpu_s: f64,
}

/// The images of a contender with one number of samples, one for each round.
#[derive(Clone, Debug)]
pub struct Series {
    /// Who rendered them.
    pub label: Label,
    /// Samples per pixel that were asked for.
    pub asked_for: u32,
    /// Samples per pixel that were taken.
    pub samples: u32,
    /// The images, round by round.
    pub runs: Vec<Run>,
}

/// Renders `count` rounds: in each, all contenders in turn with each number of samples, so that a busy machine is busy for all.
/// Each begins with another contender, and no two images have one seed, since those of more samples would repeat those of fewer.
/// Before them each renders once, which warms caches and does not count. `progress` is told how many rounds are done.
///
/// # Errors
/// If a contender fails.
pub fn rounds(
    contenders: &mut [Box<dyn Contender + '_>],
    samples: &[u32],
    count: u32,
    mut progress: impl FnMut(u32),
) -> Result<Vec<Series>> {
    let mut seeds = 0..;
    let mut seed = || seeds.next().expect("they do not run out");
    let fewest = samples.iter().copied().min().unwrap_or(1);
    let mut all = Vec::new();
    for contender in contenders.iter_mut() {
        contender.render(fewest, seed())?;
        all.extend(samples.iter().map(|&samples| Series {
            label: contender.label(),
            asked_for: samples,
            samples,
            runs: Vec::new(),
        }));
    }
    for round in 0..count as usize {
        for (which, &samples_asked) in samples.iter().enumerate() {
            for turn in 0..contenders.len() {
                let index = (round + turn) % contenders.len();
                let series = &mut all[index * samples.len() + which];
                let rendered = contenders[index]
                    .render(samples_asked, seed())
                    .with_context(|| format!("{} did not render", series.label.renderer))?;
                series.samples = rendered.samples;
                series.runs.push(Run {
                    image: rendered.image,
                    cpu_s: rendered.cpu_s,
                });
            }
        }
        progress(round as u32 + 1);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::collections::BTreeSet;

    use super::*;

    struct Noted<'a> {
        name: &'static str,
        calls: &'a RefCell<Vec<(&'static str, u32, u32)>>,
    }

    impl Contender for Noted<'_> {
        fn label(&self) -> Label {
            Label {
                renderer: self.name.to_owned(),
                variant: String::new(),
                sampler: String::new(),
            }
        }

        fn render(&mut self, samples: u32, seed: u32) -> Result<Rendered> {
            self.calls.borrow_mut().push((self.name, samples, seed));
            Ok(Rendered {
                image: vec![[seed as f32; 3]],
                samples: samples.next_power_of_two(),
                cpu_s: 1.0,
            })
        }
    }

    #[test]
    fn contenders_take_turns_and_share_no_seed() {
        let calls = RefCell::new(Vec::new());
        let noted = |name| -> Box<dyn Contender + '_> {
            Box::new(Noted {
                name,
                calls: &calls,
            })
        };
        let all = rounds(&mut [noted("a"), noted("b")], &[3, 16], 2, |_| ()).unwrap();
        let calls = calls.into_inner();
        let order: Vec<_> = calls.iter().map(|&(name, n, _)| (name, n)).collect();
        let warm = [("a", 3), ("b", 3)];
        let first = [("a", 3), ("b", 3), ("a", 16), ("b", 16)];
        let second = [("b", 3), ("a", 3), ("b", 16), ("a", 16)];
        assert_eq!(order, [&warm[..], &first, &second].concat());
        let seeds: BTreeSet<_> = calls.iter().map(|call| call.2).collect();
        assert_eq!(seeds.len(), calls.len());
        // Each series has the images of its contender and number of samples, and none of those that warm up.
        let who = |series: &Series| (series.label.renderer.clone(), series.samples);
        let expected = [("a", 4), ("a", 16), ("b", 4), ("b", 16)];
        assert_eq!(
            all.iter().map(who).collect::<Vec<_>>(),
            expected.map(|(name, n)| (name.to_owned(), n))
        );
        for series in &all {
            let seeds = series.runs.iter().map(|run| run.image[0][0] as u32);
            let of_series = calls[2..]
                .iter()
                .filter(|call| call.0 == series.label.renderer && call.1 == series.asked_for);
            assert!(seeds.eq(of_series.map(|call| call.2)));
        }
    }
}
