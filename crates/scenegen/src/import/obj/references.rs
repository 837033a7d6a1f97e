//! Checks that faces refer to what there is, once all of it is known.

use super::corner::Attribute;
use super::geometry::Geometry;
use super::occurrences::Occurrences;
use crate::import::warnings::Warnings;

/// Leaves out faces that refer to vertices that are not there, and the references of corners to other attributes
/// that are not there.
pub(super) fn check(geometry: &mut Geometry, warnings: &mut Warnings) {
    let Geometry {
        positions,
        uvs,
        normals,
        faces,
        corners,
        ..
    } = geometry;
    let mut lost_faces = Occurrences::default();
    let optional = [
        (Attribute::TextureCoordinate, "vt", uvs.len()),
        (Attribute::Normal, "vn", normals.len()),
    ];
    let mut lost = optional
        .map(|(attribute, keyword, count)| (attribute, keyword, count, Occurrences::default()));
    for face in faces {
        let corners = &mut corners[face.corner_range()];
        if corners
            .iter()
            .any(|corner| corner.position() >= positions.len())
        {
            lost_faces.note(face.line as usize);
            face.remove_corners();
            continue;
        }
        for corner in corners {
            for (attribute, _, count, occurrences) in &mut lost {
                if corner.get(*attribute).is_some_and(|index| index >= *count) {
                    corner.remove(*attribute);
                    occurrences.note(face.line as usize);
                }
            }
        }
    }
    let count = positions.len();
    let message = format!("faces refer to a v that is none of the {count}, and are left out");
    lost_faces.warn(&message, warnings);
    for (_, keyword, count, occurrences) in lost {
        let message = match count {
            // Some exporters leave out the attribute and keep the indices.
            0 => format!("corners refer to {keyword}, of which there are none"),
            _ => {
                format!("corners refer to a {keyword} that is none of the {count}, and go without")
            }
        };
        occurrences.warn(&message, warnings);
    }
}
