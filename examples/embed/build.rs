//! Generates the renderer of the scene.

#[path = "src/settings.rs"]
mod settings;

fn main() {
    if let Err(error) =
        residual_scenegen::build_script::generate(settings::SCENE, &settings::plan_options())
    {
        println!("cargo::error={error}");
    }
}
