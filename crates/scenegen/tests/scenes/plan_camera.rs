//! What a file's camera frames and what it clips, in images of any shape.

use crate::common;
use crate::common::gltf_text::Gltf;
use residual_render::camera::CameraRecord;
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::plan::{CameraChoice, Plan, PlanOptions, View, plan};
use serde_json::{Value, json};

/// The unit square in z = 0 of glTF's node 0, seen by a camera 5 in front of its centre.
fn scene(camera: &Value) -> SceneDesc {
    let mut gltf = Gltf::square();
    gltf.indices(common::gltf_text::U8, &[0, 1, 2, 0, 2, 3], 6);
    gltf.json["cameras"] = json!([camera]);
    gltf.json["nodes"] =
        json!([{ "mesh": 0 }, { "camera": 0, "name": "eye", "translation": [0.5, 0.5, 5] }]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1]);
    gltf.import().unwrap()
}

fn planned(camera: &Value, size: [u32; 2]) -> Plan {
    let options = PlanOptions {
        size,
        ..PlanOptions::default()
    };
    plan(&scene(camera), &options).unwrap()
}

/// Half the width and the height of the film.
fn half(plan: &Plan) -> [f32; 2] {
    let camera: CameraRecord = plan.data.record(0);
    [camera.right, camera.up].map(|v| v.to_array().map(|c| c * c).iter().sum::<f32>().sqrt())
}

#[test]
fn all_of_the_frame_is_seen_in_images_of_any_shape() {
    let tan = (0.5_f32 * 0.8).tan();
    let perspective = json!({ "type": "perspective",
        "perspective": { "yfov": 0.8, "aspectRatio": 2, "znear": 0.1 } });
    let orthographic = json!({ "type": "orthographic",
        "orthographic": { "xmag": 3, "ymag": 1.5, "znear": 0, "zfar": 100 } });
    for (camera, height) in [(perspective, tan), (orthographic, 1.5)] {
        for (size, expected) in [
            ([200, 100], [2.0, 1.0]),
            // Wider than the frame: more is seen beside it.
            ([400, 100], [4.0, 1.0]),
            // Narrower: more is seen above and below it.
            ([100, 100], [2.0, 2.0]),
            ([640, 480], [2.0, 1.5]),
            ([10, 1000], [2.0, 200.0]),
            // A pixel is wider than what is missing here.
            ([1999, 1000], [1.999, 1.0]),
        ] {
            let found = half(&planned(&camera, size));
            for (found, expected) in found.into_iter().zip(expected) {
                let expected = expected * height;
                assert!(
                    (found / expected - 1.0).abs() < 1e-5,
                    "{size:?}: {found} {expected}"
                );
            }
        }
    }
    // Without a shape of its own, the height counts.
    let camera = json!({ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } });
    let [width, height] = half(&planned(&camera, [100, 400]));
    assert!((height - tan).abs() < 1e-6 && (width - 0.25 * tan).abs() < 1e-6);
}

#[test]
fn a_field_of_view_that_the_user_gives_is_no_frame() {
    let camera = json!({ "type": "perspective",
        "perspective": { "yfov": 0.8, "aspectRatio": 2, "znear": 0.1 } });
    let options = PlanOptions {
        size: [100, 100],
        camera: CameraChoice::View(View {
            fov: Some(90.0),
            ..View::default()
        }),
        ..PlanOptions::default()
    };
    let [width, height] = half(&plan(&scene(&camera), &options).unwrap());
    assert!((width - 1.0).abs() < 1e-6 && (height - 1.0).abs() < 1e-6);
}

#[test]
fn clip_distances_are_ignored_in_words_where_they_cut_something_off() {
    let says = |camera: &Value| {
        let plan = planned(camera, [100, 100]);
        let warning = plan
            .warnings
            .iter()
            .find(|warning| warning.place == "camera \"eye\"");
        let dismissed = plan
            .dismissed
            .iter()
            .any(|dismissed| dismissed.reason.contains("znear"));
        assert_eq!(warning.is_none(), dismissed);
        warning.map_or("", |warning| &warning.message).to_owned()
    };
    let perspective = |near: f64, far: Option<f64>| {
        let mut camera = json!({ "type": "perspective",
            "perspective": { "yfov": 0.2, "znear": near } });
        if let Some(far) = far {
            camera["perspective"]["zfar"] = json!(far);
        }
        camera
    };
    assert_eq!(says(&perspective(0.1, None)), "");
    assert_eq!(says(&perspective(5.0, Some(5.0))), "");
    assert!(says(&perspective(6.0, None)).contains("nearer than znear 6 is rendered"));
    assert!(says(&perspective(0.1, Some(4.0))).contains("farther than zfar 4 is rendered"));
    assert!(says(&perspective(6.0, Some(4.0))).contains("nearer than znear 6 or farther than"));
    let orthographic = |magnitude: f64, near: f64| {
        json!({ "type": "orthographic", "orthographic":
            { "xmag": magnitude, "ymag": magnitude, "znear": near, "zfar": 100 } })
    };
    assert_eq!(says(&orthographic(1.0, 0.0)), "");
    assert!(says(&orthographic(1.0, 6.0)).contains("znear"));
    // What reaches behind the eye, or passes it outside of the image, is not clipped by znear.
    for (node, expected) in [
        (json!({ "mesh": 0, "translation": [0, 0, 30] }), false),
        (json!({ "mesh": 0, "translation": [4, 0, 4.95] }), false),
        (json!({ "mesh": 0, "translation": [0, 0, 4.95] }), true),
        // A wall that begins behind the eye and passes it, seen only farther away.
        (
            json!({ "mesh": 0, "translation": [1.5, 0, 10], "rotation": [0, 0.707_106_77, 0, 0.707_106_77], "scale": [30, 1, 1] }),
            false,
        ),
    ] {
        let mut gltf = Gltf::square();
        gltf.indices(common::gltf_text::U8, &[0, 1, 2, 0, 2, 3], 6);
        gltf.json["cameras"] = json!([perspective(0.1, None)]);
        gltf.json["nodes"] =
            json!([node, { "camera": 0, "name": "eye", "translation": [0.5, 0.5, 5] }]);
        gltf.json["scenes"][0]["nodes"] = json!([0, 1]);
        let plan = plan(&gltf.import().unwrap(), &PlanOptions::default()).unwrap();
        let warned = plan.warnings.iter().any(|w| w.message.contains("znear"));
        assert_eq!(warned, expected, "{node}");
    }
}
