//! Files of others with the shutter open: none panics, and all that move are rendered.

use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::{scene_files, scenes};

use super::file::{interpret, options};

const SIZE: [u32; 2] = [16, 16];
/// Files that are larger make tests wait.
const LARGEST: u64 = 4 << 20;

#[test]
fn shared_scenes_move_or_do_not() {
    let Some(scenes) = scenes() else { return };
    let mut moving = 0;
    for folder in ["malformed", "materials", "peers"] {
        for file in scene_files(&scenes.join(folder)) {
            if file.metadata().expect("a file").len() > LARGEST {
                continue;
            }
            let import_options = ImportOptions {
                moments: vec![0.1, 0.6],
                ..ImportOptions::default()
            };
            let plan_options = PlanOptions {
                size: SIZE,
                ..PlanOptions::default()
            };
            let Ok(scene) = import(&file, &import_options) else {
                continue;
            };
            let Ok(plan) = plan(&scene, &plan_options) else {
                continue;
            };
            if plan.motion.is_some() {
                let film = interpret(&plan, &options(SIZE, 2, 0));
                assert_eq!(film.invalid_samples(), 0, "{}", file.display());
                moving += 1;
            }
        }
    }
    assert!(moving >= 6, "{moving}");
}
