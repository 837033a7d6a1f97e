//! Sets of texture coordinates: files number any, a scene has two for each mesh. Each material chooses those that its
//! textures read.

/// The sets that become the scene's two.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct UvSets([Option<u32>; 2]);

impl UvSets {
    /// Which of the scene's two is set `n` of `TEXCOORD_n`; `None` where two others are in use.
    pub(super) fn index_of(&mut self, n: u32) -> Option<usize> {
        let Self(sets) = self;
        if let Some(known) = sets.iter().position(|set| *set == Some(n)) {
            return Some(known);
        }
        let same = usize::try_from(n).ok().filter(|&index| index < 2);
        let mut choices = same.into_iter().chain([0, 1]);
        let free = choices.find(|&index| sets[index].is_none())?;
        sets[free] = Some(n);
        Some(free)
    }

    /// For each of the scene's two, `n` of `TEXCOORD_n`.
    pub(super) fn numbers(self) -> [u32; 2] {
        let Self([first, second]) = self;
        [first.unwrap_or(0), second.unwrap_or(1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_two_sets_are_kept_apart() {
        let numbers = |wanted: &[u32]| {
            let mut sets = UvSets::default();
            let indices: Vec<_> = wanted.iter().map(|&n| sets.index_of(n)).collect();
            (indices, sets.numbers())
        };
        assert_eq!(numbers(&[]), (vec![], [0, 1]));
        assert_eq!(
            numbers(&[1, 0, 1]),
            (vec![Some(1), Some(0), Some(1)], [0, 1])
        );
        assert_eq!(numbers(&[3]), (vec![Some(0)], [3, 1]));
        assert_eq!(numbers(&[3, 0]), (vec![Some(0), Some(1)], [3, 0]));
        assert_eq!(
            numbers(&[0, 7, 0]),
            (vec![Some(0), Some(1), Some(0)], [0, 7])
        );
        assert_eq!(numbers(&[1, 2, 3]), (vec![Some(1), Some(0), None], [2, 1]));
    }
}
