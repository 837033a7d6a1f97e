//! Unlit surfaces have their own colour under any light.

use glam::Vec4;
use residual_device_cpu::LaneCount;
use residual_scenegen::desc::{MaterialDesc, MeshDesc, Projection, PunctualKind, SurfaceDesc};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::fixtures::{Builder, color, material, sheet};
use residual_tests::{Look, Prepared};

#[test]
fn unlit_surfaces_show_their_colour_times_that_of_vertices() {
    const SIZE: [u32; 2] = [16, 16];
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
