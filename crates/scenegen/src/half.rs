//! Numbers of 16 bits (IEEE 754 binary16): what images store that have values above 1, and no more digits than that.

/// The bits of a number that is neither negative nor above the largest, rounded to the nearest number of 16 bits.
pub(crate) fn rounded(value: f32) -> u16 {
    let bits = value.to_bits();
    // Below 2⁻¹⁴ they are multiples of 2⁻²⁴.
    if value < f32::from_bits((127 - 14) << 23) {
        return (f64::from(value) * f64::from(1 << 24)).round_ties_even() as u16;
    }
    let rest = bits & 0x1fff;
    let down = (bits >> 13) - ((127 - 15) << 10);
    let up = rest > 0x1000 || (rest == 0x1000 && down & 1 == 1);
    (down + u32::from(up)).min(0x7bff) as u16
}

/// The number of these bits, whose sign is ignored.
fn value(bits: u16) -> f32 {
    let bits = u32::from(bits & 0x7fff);
    match bits {
        ..0x400 => (f64::from(bits) / f64::from(1 << 24)) as f32,
        _ => f32::from_bits((bits << 13) + ((127 - 15) << 23)),
    }
}

/// Whether 16 bits hold all of a number.
pub(crate) fn is_exact(number: f32) -> bool {
    (0.0..=65504.0).contains(&number) && value(rounded(number)).to_bits() == number.to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_halves_are_exact_and_other_numbers_are_not() {
        for bits in 0..=0x7bff {
            let number = value(bits);
            assert!(is_exact(number) && rounded(number) == bits, "{bits:x}");
            if bits > 0 {
                // The middle to the one below goes to the even one.
                let middle = 0.5 * (number + value(bits - 1));
                assert!(!is_exact(middle), "{bits:x}");
                assert_eq!(rounded(middle), bits - (bits & 1), "{bits:x}");
            }
        }
        assert_eq!(
            [0x3c00, 0x0001, 0x7bff].map(value),
            [1.0, 2.0_f32.powi(-24), 65504.0]
        );
        for other in [-1.0, -0.0, 65505.0, f32::INFINITY, f32::NAN, 0.1, 1e-30] {
            assert!(!is_exact(other), "{other}");
        }
    }
}
