//! Cameras within bodies, against Beer's law.

use residual_scenegen::desc::{Attenuation, MetallicRoughness};

use super::{TEA, WINE, after, assert_near, body, cuboid, rendered, under_white_sky};

/// The camera at z = 5 is within bodies, or between them: light comes through what is between it and their surfaces.
#[test]
fn the_camera_is_in_the_bodies_around_it() {
    let tea = Attenuation {
        distance: 4.0,
        ..TEA
    };
    let wine = Attenuation {
        distance: 4.0,
        ..WINE
    };
    let with = |attenuation, priority| MetallicRoughness {
        priority,
        ..body(1.0, Some(attenuation))
    };
    let from_to = |back: f32, front: f32, half: f32| {
        cuboid([-half, -half, back], [2.0 * half, 2.0 * half, front - back])
    };
    let check = |name: &str, bodies: Vec<_>, lengths: [f64; 2]| {
        let expected = after([(tea, lengths[0]), (wine, lengths[1])]);
        assert_near(
            name,
            rendered(&under_white_sky(bodies), 1024),
            expected,
            3e-3,
        );
    };
    let long = || (with(tea, 0), from_to(1.0, 7.0, 0.5));
    check("within", vec![long()], [4.0, 0.0]);
    let behind = (with(tea, 0), from_to(6.0, 7.0, 0.5));
    check("before", vec![behind], [0.0, 0.0]);
    let within = (with(wine, 0), from_to(3.0, 6.0, 0.4));
    check("within two", vec![long(), within], [2.0, 2.0]);
    // Of both, the one of the higher priority is there, as far as it goes.
    let lower = (with(wine, -1), from_to(3.0, 6.0, 0.4));
    check("of a lower priority", vec![long(), lower], [4.0, 0.0]);
    let higher = (with(wine, 1), from_to(0.0, 8.0, 0.6));
    check("of a higher one", vec![long(), higher], [0.0, 5.0]);
}
