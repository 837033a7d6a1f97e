//[camera
// A sample is a row of numbers: radiance, and the channels of its layers.
fn add(slot: u32, color: vec3f) {
    let first = slot * STRIDE;
    samples[first] += color.x;
    samples[first + 1u] += color.y;
    samples[first + 2u] += color.z;
}
//]
//[lights
// A list of contributions and the samples that they are for, in any order. Where it is too short, the host sees that it is.
fn add(sample: u32, color: vec3f) {
    let first = 4u * atomicAdd(&queues.splats, 1u);
    if first >= arrayLength(&samples) {
        return;
    }
    samples[first] = color.x;
    samples[first + 1u] = color.y;
    samples[first + 2u] = color.z;
    samples[first + 3u] = bitcast<f32>(sample);
}

// The sample of a pixel that has the number of a path's.
fn sample_in(pixel: u32, slot: u32) -> u32 {
    return (settings.first + slot) / settings.places * settings.places + pixel;
}
//]

// The index of a path's sample among those of its pixel.
fn sample_of(slot: u32) -> u32 {
    return settings.first_sample + (settings.first + slot) / settings.places;
}

//[camera
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
//]
//[lights
// As many paths as there are pixels, row by row.
fn pixel_of(slot: u32) -> vec2u {
    let place = (settings.first + slot) % settings.places;
    return vec2u(place % settings.columns, place / settings.columns);
}
//]
