//! The statements of an OBJ file, in any order.
//!
//! A line that makes no sense costs what it says and not the file: a vertex, a face, or an attribute of a corner.

use glam::{DVec3, Vec2, Vec3};

use super::corner::Corner;
use super::geometry::{Face, Geometry, NamedMaterial, Part};
use super::lines::{comment_start, line_place, statements, words};
use super::numbers::SEPARATORS;
use super::occurrences::Occurrences;
use super::vertex_colors::VertexColors;
use super::{numbers, origin, polypaint};
use crate::import::budget::Budget;
use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// Reads a file's text.
pub(super) fn parse(
    text: &str,
    budget: &mut Budget,
    warnings: &mut Warnings,
) -> Result<Geometry, Fault> {
    let mut parser = Parser::default();
    for statement in statements(text) {
        let (keyword, rest) = statement.split();
        parser.statement(statement.line, &keyword, rest, budget, warnings)?;
    }
    parser.paint_last_vertices();
    parser.warn(warnings);
    let (origin, positions) = origin::relative(&parser.positions, &parser.geometry.corners);
    Ok(Geometry {
        origin,
        positions,
        ..parser.geometry
    })
}

#[derive(Default)]
struct Parser {
    /// But for the positions.
    geometry: Geometry,
    positions: Vec<DVec3>,
    /// Of a block of `#MRGB`, for the vertices before it.
    polypaint: Vec<[f32; 3]>,
    part_name: String,
    material: Option<usize>,
    smoothing_group: u32,
    /// Whether faces continue the last part.
    part_is_open: bool,
    faults: Faults,
}

/// What is said once for all lines.
#[derive(Default)]
struct Faults {
    points_and_lines: usize,
    short_faces: Occurrences,
    bad_corners: Occurrences,
    bad_vertices: Occurrences,
    decimal_commas: Occurrences,
    separators: Occurrences,
    bad_polypaint: Occurrences,
    lost_polypaint: usize,
    bad_texture_coordinates: Occurrences,
    bad_normals: Occurrences,
    weights: Occurrences,
    extra_numbers: Occurrences,
    free_forms: Occurrences,
    unknown: Occurrences,
    first_unknown: String,
}

impl Parser {
    fn statement(
        &mut self,
        line: usize,
        keyword: &str,
        rest: &str,
        budget: &mut Budget,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        match keyword {
            "v" => {
                self.paint_last_vertices();
                budget.charge(1, size_of::<(DVec3, Vec3)>() as u64, keyword)?;
                self.vertex(line, rest);
                if self.geometry.colors.is_some() {
                    budget.charge(1, VertexColors::BYTES, keyword)?;
                }
            }
            "vt" => {
                budget.charge(1, size_of::<Vec2>() as u64, keyword)?;
                let [u, v] = self.numbers(line, rest, 1);
                if u.is_nan() || v.is_nan() {
                    self.faults.bad_texture_coordinates.note(line);
                }
                // OBJ's v grows upwards.
                self.geometry.uvs.push(Vec2::new(u as f32, 1.0 - v as f32));
            }
            "vn" => {
                budget.charge(1, size_of::<Vec3>() as u64, keyword)?;
                let normal = DVec3::from(self.numbers(line, rest, 3)).as_vec3();
                if normal.is_nan() {
                    self.faults.bad_normals.note(line);
                }
                self.geometry.normals.push(normal);
            }
            "#mrgb" => {
                budget.charge(rest.len() as u64 / 8, VertexColors::BYTES, keyword)?;
                if polypaint::read(rest, &mut self.polypaint).is_none() {
                    self.faults.bad_polypaint.note(line);
                }
            }
            // `fo` is what faces were called once.
            "f" | "fo" => self.face(line, rest, budget)?,
            "o" | "g" => {
                let end = comment_start(rest).unwrap_or(rest.len());
                self.part_name = rest[..end].trim().to_owned();
                self.part_is_open = false;
            }
            "s" => match words(rest).next() {
                Some("off" | "null") | None => self.smoothing_group = 0,
                Some("on") => self.smoothing_group = 1,
                Some(group) => match group.parse() {
                    Ok(group) => self.smoothing_group = group,
                    Err(_) => warnings.push(
                        line_place(line),
                        format!("s \"{group}\" is no smoothing group and ignored"),
                    ),
                },
            },
            "usemtl" if rest.is_empty() => {
                warnings.push(line_place(line), "usemtl without a name is ignored")
            }
            "usemtl" => self.use_material(line, rest),
            "mtllib" => self.geometry.libraries.push((line, rest.to_owned())),
            "p" | "l" => self.faults.points_and_lines += 1,
            "vp" | "cstype" | "deg" | "bmat" | "step" | "curv" | "curv2" | "surf" | "parm"
            | "trim" | "hole" | "scrv" | "sp" | "end" | "con" | "bsp" | "bzp" | "cdc" | "cdp"
            | "res" => {
                self.faults.free_forms.note(line);
            }
            // How finely curves are drawn, and merging groups of theirs.
            "mg" | "bevel" | "c_interp" | "d_interp" | "lod" | "ctech" | "stech" => {}
            _ => {
                if self.faults.first_unknown.is_empty() {
                    self.faults.first_unknown = keyword.chars().take(20).collect();
                }
                self.faults.unknown.note(line);
            }
        }
        Ok(())
    }

    /// The words of a statement without what separates numbers from one another.
    fn fields<'t>(
        &mut self,
        line: usize,
        rest: &'t str,
    ) -> impl Iterator<Item = &'t str> + use<'t> {
        let may_have_separators = rest.bytes().any(|byte| matches!(byte, b',' | b';'));
        if may_have_separators && words(rest).any(|word| word.ends_with(SEPARATORS)) {
            self.faults.separators.note(line);
        }
        words(rest)
            .map(|word| word.trim_end_matches(SEPARATORS))
            .filter(|word| !word.is_empty())
    }

    /// The first numbers of a statement, NaN where there is none; those from index `required` on may be missing and
    /// are 0.
    fn numbers<const N: usize>(&mut self, line: usize, rest: &str, required: usize) -> [f64; N] {
        let mut fields = self.fields(line, rest);
        std::array::from_fn(|index| match fields.next() {
            Some(word) => self.number(line, word),
            None if index < required => f64::NAN,
            None => 0.0,
        })
    }

    fn number(&mut self, line: usize, word: &str) -> f64 {
        if word.contains(',') {
            self.faults.decimal_commas.note(line);
        }
        numbers::parse_exactly(word).unwrap_or(f64::NAN)
    }

    /// A block of colours, which ends where vertices begin, is for as many vertices before it.
    fn paint_last_vertices(&mut self) {
        if !self.polypaint.is_empty() {
            let vertices = self.positions.len();
            let lost = self.geometry.colors.paint_last(&self.polypaint, vertices);
            self.faults.lost_polypaint += lost;
            self.polypaint.clear();
        }
    }

    /// Three numbers, and behind them nothing, a weight or a colour.
    fn vertex(&mut self, line: usize, rest: &str) {
        let position = DVec3::from(self.numbers(line, rest, 3));
        if position.is_nan() {
            self.faults.bad_vertices.note(line);
        }
        let mut further = words(rest)
            .map(|word| word.trim_end_matches(SEPARATORS))
            .filter(|word| !word.is_empty())
            .skip(3);
        let color = match [
            further.next(),
            further.next(),
            further.next(),
            further.next(),
        ] {
            [None, ..] => None,
            // A weight is for curves; the vertex of a polygon is where its three numbers say.
            [Some(weight), None, ..] => {
                if numbers::parse(weight) != Some(1.0) {
                    self.faults.weights.note(line);
                }
                None
            }
            [Some(_), Some(_), None, _] => {
                self.faults.extra_numbers.note(line);
                None
            }
            [Some(r), Some(g), Some(b), beyond] => {
                if beyond.is_some() {
                    self.faults.extra_numbers.note(line);
                }
                Some([r, g, b].map(|word| self.number(line, word) as f32))
            }
        };
        self.geometry.colors.push(color, self.positions.len());
        self.positions.push(position);
    }

    fn face(&mut self, line: usize, rest: &str, budget: &mut Budget) -> Result<(), Fault> {
        let fields = self.fields(line, rest);
        let geometry = &mut self.geometry;
        let counts = [
            self.positions.len(),
            geometry.uvs.len(),
            geometry.normals.len(),
        ];
        let first_corner = geometry.corners.len();
        for word in fields {
            let parsed = match Corner::parse(word, counts) {
                Some(corner) => {
                    geometry.corners.push(corner);
                    Some(())
                }
                // Some separate corners by commas alone.
                None if word.contains(SEPARATORS) => {
                    self.faults.separators.note(line);
                    word.split(SEPARATORS).try_for_each(|word| {
                        geometry.corners.push(Corner::parse(word, counts)?);
                        Some(())
                    })
                }
                None => None,
            };
            if parsed.is_none() {
                geometry.corners.truncate(first_corner);
                self.faults.bad_corners.note(line);
                return Ok(());
            }
        }
        let corner_count = geometry.corners.len() - first_corner;
        if corner_count < 3 {
            geometry.corners.truncate(first_corner);
            self.faults.short_faces.note(line);
            return Ok(());
        }
        budget.charge(corner_count as u64, size_of::<Corner>() as u64, "f")?;
        budget.charge(1, size_of::<Face>() as u64, "f")?;
        geometry.faces.push(Face {
            line: line as u32,
            first_corner: first_corner as u32,
            corner_count: corner_count as u32,
            smoothing_group: self.smoothing_group,
        });
        if !self.part_is_open {
            self.part_is_open = true;
            geometry.parts.push(Part {
                name: match self.part_name.as_str() {
                    "" => "unnamed_object".to_owned(),
                    name => name.to_owned(),
                },
                material: self.material,
                first_face: geometry.faces.len() - 1,
                face_count: 0,
            });
        }
        geometry
            .parts
            .last_mut()
            .expect("a part is open")
            .face_count += 1;
        Ok(())
    }

    fn use_material(&mut self, line: usize, name: &str) {
        let materials = &mut self.geometry.materials;
        let libraries_before = self.geometry.libraries.len();
        let is_known = |index: usize| {
            let known: &NamedMaterial = &materials[index];
            known.name == name && known.libraries_before == libraries_before
        };
        // Files repeat the statement before each group.
        if !self.material.is_some_and(is_known) {
            materials.push(NamedMaterial {
                line,
                name: name.to_owned(),
                libraries_before,
            });
            self.material = Some(materials.len() - 1);
            self.part_is_open = false;
        }
    }

    fn warn(&self, warnings: &mut Warnings) {
        let faults = &self.faults;
        if faults.points_and_lines > 0 {
            let message = format!(
                "{} points and lines are not rendered",
                faults.points_and_lines
            );
            warnings.push("p, l", message);
        }
        for (occurrences, message) in [
            (
                &faults.short_faces,
                "faces have fewer than three corners and are left out",
            ),
            (
                &faults.bad_corners,
                "faces have a word that is no index and are left out",
            ),
            (
                &faults.bad_vertices,
                "vertices lack a number; faces with them are left out",
            ),
            (
                &faults.decimal_commas,
                "numbers have a comma, which is read as a decimal point",
            ),
            (
                &faults.separators,
                "lines have commas or semicolons behind numbers, which are ignored",
            ),
            (
                &faults.bad_polypaint,
                "lines of #MRGB are not of 8 hexadecimal digits for each vertex; the rest of them is ignored",
            ),
            (
                &faults.bad_texture_coordinates,
                "texture coordinates lack a number",
            ),
            (&faults.bad_normals, "normals lack a number"),
            (
                &faults.weights,
                "vertices have a weight, which is for curves and ignored",
            ),
            (
                &faults.extra_numbers,
                "vertices have numbers that are neither weight nor colour; they are ignored",
            ),
            (
                &faults.free_forms,
                "statements of free-form curves and surfaces are not rendered",
            ),
        ] {
            occurrences.warn(message, warnings);
        }
        if faults.lost_polypaint > 0 {
            let lost = faults.lost_polypaint;
            warnings.push(
                "#MRGB",
                format!("{lost} colours are for no vertex and ignored"),
            );
        }
        let first_unknown = faults.first_unknown.escape_debug();
        let message = format!("statements such as \"{first_unknown}\" are not read");
        faults.unknown.warn(&message, warnings);
    }
}
