//! What surfaces emit: unlit ones their own colour under any light, coated ones what their coat lets through.

use glam::Vec4;
use residual_device_cpu::LaneCount;
use residual_scenegen::desc::{
    MaterialDesc, MeshDesc, MetallicRoughness, Projection, PunctualKind, SurfaceDesc,
};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::fixtures::{Builder, color, material, metallic_roughness, scalar, sheet};
use residual_tests::{Look, Prepared};

const SIZE: [u32; 2] = [16, 16];

#[test]
fn unlit_surfaces_show_their_colour_times_that_of_vertices() {
    for (tint, lit) in [(None, false), (None, true), (Some([0.5, 1.0, 0.25]), true)] {
        let mut b = Builder::new("unlit");
        let flat = MaterialDesc {
            emission: color([0.5, 0.25, 0.75]),
            ..material("flat", SurfaceDesc::Unlit)
        };
        let mesh = sheet([-9.0, -9.0, 0.0], [18.0, 0.0, 0.0], [0.0, 18.0, 0.0]);
        let colors = tint.map(|[r, g, b]| vec![Vec4::new(r, g, b, 1.0); mesh.positions.len()]);
        b.add(flat, [MeshDesc { colors, ..mesh }]);
        if lit {
            let direction = glam::Vec3::NEG_Z;
            b.light(PunctualKind::Directional { direction }, [7.0; 3]);
        }
        let lens = Projection::Orthographic { ymag: 1.0 };
        b.camera("camera", [0.0, 0.0, 3.0], [0.0, 0.0, 0.0], lens);
        let options = PlanOptions {
            size: SIZE,
            ..PlanOptions::default()
        };
        let plan = plan(&b.finish(), &options).unwrap();
        // It is no light: without one, the white sky is there as ever.
        assert_eq!(plan.structure.lights.len(), 1);
        let look = Look::new(SIZE, 4);
        let film = Prepared::new(&plan, LaneCount::native()).interpret(&look);
        let tint = tint.unwrap_or([1.0; 3]);
        for (channel, (found, color)) in film.mean().into_iter().zip([0.5, 0.25, 0.75]).enumerate()
        {
            let expected = color * f64::from(tint[channel]);
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    }
}

/// KHR_materials_clearcoat, "Emission": coated_emission = emission * (1 - clearcoat * (0.04 + 0.96 (1 - N·V)⁵)).
#[test]
fn coats_reflect_what_would_leave_them() {
    for clearcoat in [0.0_f32, 0.5, 1.0] {
        for degrees in [0.0_f64, 60.0, 80.0] {
            let coated = MetallicRoughness {
                clearcoat: scalar(clearcoat),
                ..metallic_roughness([0.5; 3], 0.0, 0.5)
            };
            let lamp = MaterialDesc {
                emission: color([2.0, 1.0, 0.5]),
                ..material("lamp", SurfaceDesc::MetallicRoughness(coated))
            };
            let mut b = Builder::new("lamp");
            b.add(
                lamp,
                [sheet([-9.0, -9.0, 0.0], [18.0, 0.0, 0.0], [0.0, 18.0, 0.0])],
            );
            let (sin, cos) = degrees.to_radians().sin_cos();
            let lens = Projection::Orthographic { ymag: 1.0 };
            b.camera(
                "camera",
                [8.0 * sin as f32, 0.0, 8.0 * cos as f32],
                [0.0; 3],
                lens,
            );
            let options = PlanOptions {
                size: SIZE,
                ..PlanOptions::default()
            };
            let plan = plan(&b.finish(), &options).unwrap();
            let film = Prepared::new(&plan, LaneCount::native()).interpret(&Look::new(SIZE, 4));
            let fresnel = 0.04 + 0.96 * (1.0 - cos).powi(5);
            let passes = 1.0 - f64::from(clearcoat) * fresnel;
            for (found, emission) in film.mean().into_iter().zip([2.0, 1.0, 0.5]) {
                let expected = emission * passes;
                assert!(
                    (found - expected).abs() < 1e-5,
                    "{clearcoat}, {degrees}: {found} {expected}"
                );
            }
        }
    }
}
