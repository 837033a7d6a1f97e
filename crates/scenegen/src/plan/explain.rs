//! A plan in words: what was decided, and why.

use residual_render::domain::Buffer;
use residual_render::program::{Leaf, Program, Source};
use residual_render::triangle::TriangleRecord;

use super::options::{Binding, LightPicks};
use super::planned::Plan;

/// A decision of the plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decision {
    /// About what.
    pub about: &'static str,
    /// What was decided, and why.
    pub text: String,
}

/// When the inputs of a program are known.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BindingTimes {
    /// Numbers and colours printed into the program.
    pub constants: usize,
    /// Those read from the material's parameter block.
    pub parameters: usize,
    /// Those read from images.
    pub images: usize,
    /// Those read from vertices.
    pub vertices: usize,
}

impl BindingTimes {
    /// Of a program's inputs, and of its alpha test.
    pub fn of(program: &Program) -> Self {
        let mut times = Self::default();
        for leaf in program.leaves() {
            match leaf {
                Leaf::Constant => times.constants += 1,
                Leaf::Parameter => times.parameters += 1,
                Leaf::Image(_) => times.images += 1,
                Leaf::VertexColor | Leaf::Coordinates(_) => times.vertices += 1,
            }
        }
        times
    }
}

impl Plan {
    /// What was decided, and why.
    pub fn decisions(&self) -> Vec<Decision> {
        let decision = |about, text| Decision { about, text };
        let materials: usize = self.materials.iter().map(Vec::len).sum();
        let lights: usize = self.lights.iter().map(|kind| kind.count).sum();
        vec![
            decision("binding times", self.binding_times()),
            decision(
                "programs",
                format!(
                    "{} for {materials} materials: those of the same structure share one",
                    self.structure.programs.len()
                ),
            ),
            decision("triangles", self.triangles()),
            decision("vertices", self.vertices()),
            decision("images", self.images()),
            decision("sides", self.sides()),
            decision("alpha tests", self.alpha_tests()),
            decision(
                "lights",
                match lights {
                    1 => "one; nothing to choose".to_owned(),
                    _ => format!(
                        "{lights} {}",
                        match self.light_picks {
                            LightPicks::Auto | LightPicks::Mixed =>
                                "in an alias table: half of the picks by power, half evenly by kind",
                            LightPicks::Power => "in an alias table: picked by power",
                            LightPicks::Uniform =>
                                "in an alias table: each picked as often as any other",
                            LightPicks::Tree => "in a tree: picked by what may arrive at the point",
                        }
                    ),
                },
            ),
            decision(
                "sampler",
                format!("{:?}: asked for", self.structure.sampler),
            ),
        ]
    }

    fn binding_times(&self) -> String {
        match self.binding {
            Binding::Structure => {
                "0 and 1 are constants, which remove code; other numbers are parameters, so that \
                                   editing them compiles nothing"
                    .to_owned()
            }
            Binding::Constants => {
                "all numbers are constants, as asked; editing one compiles again".to_owned()
            }
        }
    }

    fn triangles(&self) -> String {
        let bytes = TriangleRecord::WORDS * 4;
        format!(
            "{} of {bytes} bytes (corners, program, parameters, light, object, vertices)",
            self.data.triangle_count()
        )
    }

    fn vertices(&self) -> String {
        let attributes = [
            ("normals", Buffer::Normals),
            ("tangents", Buffer::Tangents),
            ("texture coordinates", Buffer::Uvs),
            ("colours", Buffer::Colors),
        ];
        let count = |buffer| self.data.buffer(buffer).len() / 4;
        let (read, unread): (Vec<_>, Vec<_>) = attributes
            .into_iter()
            .partition(|(_, buffer)| count(*buffer) > 0);
        let read: Vec<_> = read
            .into_iter()
            .map(|(name, buffer)| format!("{name} of {}", count(buffer)))
            .collect();
        let unread: Vec<_> = unread.into_iter().map(|(name, _)| name).collect();
        let none = |list: String| {
            if list.is_empty() {
                "none".to_owned()
            } else {
                list
            }
        };
        format!(
            "16 bytes an attribute: {}; not read, not stored: {}",
            none(read.join(", ")),
            none(unread.join(", "))
        )
    }

    fn images(&self) -> String {
        let mib = self.data.buffer(Buffer::Texels).len() as f64 * 4.0 / f64::from(1 << 20);
        format!("{mib:.1} MiB of texels as stored in the files; what no program reads is left out")
    }

    fn sides(&self) -> String {
        let culled = self.data.single_sided.iter().filter(|&&single| single);
        match (culled.count(), self.data.triangle_count()) {
            (0, _) => "both of every triangle block light: traversal does not ask".to_owned(),
            (some, all) => {
                format!("{some} of {all} triangles are seen from the front only: traversal asks")
            }
        }
    }

    fn alpha_tests(&self) -> String {
        let tested = self.data.alpha_tested.iter().filter(|&&tested| tested);
        match tested.count() {
            0 => "none: traversal does not ask".to_owned(),
            some => format!(
                "traversal asks about hits on {some} of {} triangles",
                self.data.triangle_count()
            ),
        }
    }
}
