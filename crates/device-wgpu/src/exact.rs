//! WGSL as SPIR-V in which no operation may be contracted or reassociated.
//!
//! naga's writer says nothing of it, and drivers take liberties: here every result of arithmetic on floating-point numbers
//! is decorated with `NoContraction` (SPIR-V specification, section 3.20), which takes that freedom away.

use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// What drivers are told of denormals, signs of zero, infinities and NaN (SPV_KHR_float_controls).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FloatControls {
    /// Nothing: they may flush the first, and take the others for absent.
    Unstated,
    /// To keep all of them.
    Preserve,
}

/// A module for drivers.
pub(crate) struct Spirv {
    pub(crate) words: Vec<u32>,
    /// Entry points with the sizes of their workgroups.
    pub(crate) entry_points: Vec<(String, [u32; 3])>,
}

/// Translates a text.
///
/// # Errors
/// With naga's words, if it does not accept the text.
pub(crate) fn spirv(text: &str, controls: FloatControls) -> Result<Spirv, String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::FLOAT64)
        .validate(&module)
        .map_err(|error| error.emit_to_string(text))?;
    let unchecked = BoundsCheckPolicy::Unchecked;
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::empty(),
        bounds_check_policies: BoundsCheckPolicies {
            index: unchecked,
            buffer: unchecked,
            image_load: unchecked,
            binding_array: unchecked,
        },
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        force_loop_bounding: false,
        fake_missing_bindings: true,
        emit_int_div_checks: false,
        ..spv::Options::default()
    };
    let words = spv::write_vec(&module, &info, &options, None).map_err(|e| e.to_string())?;
    let entry_points = module.entry_points.iter();
    Ok(Spirv {
        words: decorate(&words, controls),
        entry_points: entry_points
            .map(|point| (point.name.clone(), point.workgroup_size))
            .collect(),
    })
}

/// Instructions of SPIR-V, by their numbers in section 3.52 of its specification.
mod op {
    pub(super) const EXTENSION: u32 = 10;
    pub(super) const EXT_INST_IMPORT: u32 = 11;
    pub(super) const EXT_INST: u32 = 12;
    pub(super) const ENTRY_POINT: u32 = 15;
    pub(super) const EXECUTION_MODE: u32 = 16;
    pub(super) const CAPABILITY: u32 = 17;
    pub(super) const TYPE_VOID: u32 = 19;
    pub(super) const TYPE_FORWARD_POINTER: u32 = 39;
    pub(super) const DECORATE: u32 = 71;
    pub(super) const F_NEGATE: u32 = 127;
    pub(super) const F_ADD: u32 = 129;
    pub(super) const F_SUB: u32 = 131;
    pub(super) const F_MUL: u32 = 133;
    pub(super) const F_DIV: u32 = 136;
    /// `OpFRem` to `OpDot`: remainders, and products with vectors and matrices.
    pub(super) const F_REM: u32 = 140;
    pub(super) const DOT: u32 = 148;
}
/// `Fma` of GLSL.std.450.
const GLSL_FMA: u32 = 50;
const NO_CONTRACTION: u32 = 42;
/// `DenormPreserve` and `SignedZeroInfNanPreserve`, each as capability and as execution mode.
const PRESERVE: [(u32, u32); 2] = [(4464, 4459), (4466, 4461)];
/// Words before the first instruction.
const HEADER: usize = 5;

/// The same module with `NoContraction` on the results of floating-point arithmetic, and what it says of numbers that are not
/// normal.
fn decorate(words: &[u32], controls: FloatControls) -> Vec<u32> {
    let (mut at, mut glsl, mut results, mut entry_points) = (HEADER, 0, Vec::new(), Vec::new());
    let (mut capabilities_end, mut modes_end, mut first_type) = (HEADER, HEADER, None);
    while at < words.len() {
        let (code, length) = (words[at] & 0xffff, (words[at] >> 16) as usize);
        let end = at + length;
        match code {
            op::CAPABILITY => capabilities_end = end,
            op::EXT_INST_IMPORT => glsl = words[at + 1],
            op::ENTRY_POINT => {
                entry_points.push(words[at + 2]);
                modes_end = end;
            }
            op::EXECUTION_MODE => modes_end = end,
            op::F_NEGATE | op::F_ADD | op::F_SUB | op::F_MUL | op::F_DIV => {
                results.push(words[at + 2]);
            }
            op::F_REM..=op::DOT => results.push(words[at + 2]),
            op::EXT_INST if words[at + 3] == glsl && words[at + 4] == GLSL_FMA => {
                results.push(words[at + 2]);
            }
            op::TYPE_VOID..=op::TYPE_FORWARD_POINTER => {
                first_type.get_or_insert(at);
            }
            _ => {}
        }
        at = end;
    }
    // Instructions have their order: capabilities, extensions, …, modes, …, decorations, types.
    let first_type = first_type.unwrap_or(words.len());
    let mut decorated = words[..capabilities_end].to_vec();
    if controls == FloatControls::Preserve {
        for (capability, _) in PRESERVE {
            decorated.extend([2 << 16 | op::CAPABILITY, capability]);
        }
        let name = literal("SPV_KHR_float_controls");
        decorated.push((1 + name.len() as u32) << 16 | op::EXTENSION);
        decorated.extend(name);
    }
    decorated.extend(&words[capabilities_end..modes_end]);
    if controls == FloatControls::Preserve {
        for entry_point in entry_points {
            for (_, mode) in PRESERVE {
                decorated.extend([4 << 16 | op::EXECUTION_MODE, entry_point, mode, 32]);
            }
        }
    }
    decorated.extend(&words[modes_end..first_type]);
    for result in results {
        decorated.extend([3 << 16 | op::DECORATE, result, NO_CONTRACTION]);
    }
    decorated.extend(&words[first_type..]);
    decorated
}

/// A string as SPIR-V has it: bytes in words, with a zero at the end.
fn literal(text: &str) -> Vec<u32> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.push(0);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let words = bytes.as_chunks().0.iter();
    words.map(|&word| u32::from_le_bytes(word)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_is_decorated_and_nothing_else() {
        let text = "@group(0) @binding(0) var<storage, read_write> x: array<f32>;
            @compute @workgroup_size(8, 2) fn main(@builtin(global_invocation_id) id: vec3u) {
                x[id.x] = fma(x[0], x[1], -x[2]) * (x[3] + x[4]) / x[5] - floor(x[6]);
            }";
        let spirv = spirv(text, FloatControls::Unstated).unwrap();
        assert_eq!(spirv.entry_points, [("main".to_owned(), [8, 2, 1])]);
        let no_contraction = spirv
            .words
            .windows(3)
            .filter(|w| w[0] == 3 << 16 | op::DECORATE && w[2] == NO_CONTRACTION);
        // fma, negation, product, sum, quotient, difference.
        assert_eq!(no_contraction.count(), 6);
    }

    #[test]
    fn drivers_are_told_what_to_keep_in_the_order_of_instructions() {
        let text = "@compute @workgroup_size(1) fn one() {}
            @compute @workgroup_size(1) fn two() {}";
        let words = spirv(text, FloatControls::Preserve).unwrap().words;
        let mut codes = Vec::new();
        let mut at = HEADER;
        while at < words.len() {
            codes.push(words[at] & 0xffff);
            at += (words[at] >> 16) as usize;
        }
        assert_eq!(at, words.len(), "instructions fill the module");
        let count = |code| codes.iter().filter(|&&c| c == code).count();
        // Shader and two; the size of a workgroup and two for each entry point.
        assert_eq!(count(op::CAPABILITY), 3);
        assert_eq!(count(op::EXECUTION_MODE), 6);
        assert_eq!(count(op::EXTENSION), 1);
        let last = |code| codes.iter().rposition(|&c| c == code).unwrap();
        let first = |code| codes.iter().position(|&c| c == code).unwrap();
        assert!(last(op::CAPABILITY) < first(op::EXTENSION));
        assert!(last(op::ENTRY_POINT) < first(op::EXECUTION_MODE));
        assert!(last(op::EXECUTION_MODE) < first(op::TYPE_VOID));
        let plain = spirv(text, FloatControls::Unstated).unwrap().words;
        assert!(plain.len() < words.len());
    }

    #[test]
    fn texts_that_are_no_wgsl_are_refused_in_words() {
        let error = spirv("fn main() { let x = ; }", FloatControls::Unstated)
            .err()
            .unwrap();
        assert!(error.contains("expected"), "{error}");
    }
}
