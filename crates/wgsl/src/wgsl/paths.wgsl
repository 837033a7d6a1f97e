// A sample is a row of numbers: radiance, and the channels of its layers.
fn add(slot: u32, color: vec3f) {
    let first = slot * STRIDE;
    samples[first] += color.x;
    samples[first + 1u] += color.y;
    samples[first + 2u] += color.z;
}

// The index of a path's sample among those of its pixel.
fn sample_of(slot: u32) -> u32 {
    return settings.first_sample + (settings.first + slot) / settings.places;
}

// Paths of neighbouring slots belong to neighbouring pixels: block after block of 8 × 8.
fn pixel_of(slot: u32) -> vec2u {
    let place = (settings.first + slot) % settings.places;
    let block = place / 64u;
    let within = place % 64u;
    return vec2u(
        block % settings.columns * 8u + within % 8u,
        block / settings.columns * 8u + within / 8u,
    );
}
