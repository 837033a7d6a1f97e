//! Sorting networks: fixed sequences of exchanges, so that sorting has no branches to mispredict.
//!
//! Batcher's merge exchange makes one for any number of keys (D. E. Knuth, *The Art of Computer
//! Programming* 3, 5.2.2, Algorithm M). Bose and Nelson's networks are as short up to eight keys,
//! and longer beyond.

/// The most keys that [`sort`] takes.
pub(crate) const MOST_KEYS: usize = 8;

/// Comparators of the networks of up to 16 keys.
const MOST_COMPARATORS: usize = 63;

/// Pairs of indices, the lower first, to be put in order one after the other.
struct Network {
    comparators: [[usize; 2]; MOST_COMPARATORS],
    len: usize,
}

impl Network {
    /// The network of 1 to 16 keys.
    const fn of(keys: usize) -> Network {
        let mut network = Network {
            comparators: [[0; 2]; MOST_COMPARATORS],
            len: 0,
        };
        let widest = keys.next_power_of_two() / 2;
        let mut stride = widest;
        while stride > 0 {
            // Sequences of every `stride`-th key are merged: keys `distance` apart are exchanged
            // where the lower index has `parity` in the bit of the stride.
            let (mut distance, mut parity, mut next) = (stride, 0, widest);
            loop {
                let mut low = 0;
                while low + distance < keys {
                    if low & stride == parity {
                        network.comparators[network.len] = [low, low + distance];
                        network.len += 1;
                    }
                    low += 1;
                }
                if next == stride {
                    break;
                }
                (distance, parity, next) = (next - stride, stride, next / 2);
            }
            stride /= 2;
        }
        network
    }
}

/// Sorts in descending order; straight-line code for each number of keys, which stay in registers.
#[inline(always)]
pub(crate) fn sort<const KEYS: usize>(keys: &mut [u64; KEYS]) {
    // A loop would leave it to the optimiser whether indices are constants.
    macro_rules! exchange {
        ($($comparator:literal)*) => {
            const { assert!(Network::of(KEYS).len <= [$($comparator),*].len()) };
            $(if const { $comparator < Network::of(KEYS).len } {
                let [low, high] = const { Network::of(KEYS).comparators[$comparator] };
                let (a, b) = (keys[low], keys[high]);
                (keys[low], keys[high]) = (a.max(b), a.min(b));
            })*
        };
    }
    exchange!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The 0-1 principle: a network that sorts all sequences of zeros and ones sorts everything.
    #[test]
    fn networks_of_all_sizes_sort() {
        for keys in 1..=16 {
            let network = Network::of(keys);
            for ones in 0..1u32 << keys {
                let sorted =
                    network.comparators[..network.len]
                        .iter()
                        .fold(ones, |bits, &[low, high]| {
                            assert!(low < high && high < keys);
                            let descends = bits >> low & 1 >= bits >> high & 1;
                            if descends {
                                bits
                            } else {
                                bits ^ (1 << low | 1 << high)
                            }
                        });
                assert_eq!(sorted, (1 << ones.count_ones()) - 1, "{keys} keys");
            }
        }
    }

    /// Knuth's numbers (5.3.4, table 1): the least possible up to eight keys.
    #[test]
    fn networks_are_as_long_as_known() {
        let lengths: Vec<usize> = (1..=16).map(|keys| Network::of(keys).len).collect();
        assert_eq!(
            lengths,
            [0, 1, 3, 5, 9, 12, 16, 19, 26, 31, 37, 41, 48, 53, 59, 63]
        );
    }

    #[test]
    fn straight_line_code_follows_the_networks() {
        fn check<const KEYS: usize>() {
            for ones in 0..1u32 << KEYS {
                // Keys of equal parts differ in the low half, as those of children do.
                let mut keys: [u64; KEYS] =
                    std::array::from_fn(|i| u64::from(ones >> i & 1) << 32 | i as u64);
                let mut expected = keys;
                expected.sort_by(|a, b| b.cmp(a));
                sort(&mut keys);
                assert_eq!(keys, expected);
            }
        }
        check::<1>();
        check::<2>();
        check::<3>();
        check::<4>();
        check::<5>();
        check::<6>();
        check::<7>();
        check::<MOST_KEYS>();
    }
}
