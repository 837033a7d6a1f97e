//! JPEG files of four channels, as print programs write them.

use crate::common::gltf_text::warns;
use crate::common::obj_text::{TRIANGLE, try_import};
use residual_scenegen::desc::Texels;

/// A file of 8 × 8 texels of one value. `transform` is what Adobe's marker says: 0 CMYK, 2 YCCK.
fn jpeg(stored: [u8; 4], transform: u8) -> Vec<u8> {
    let segment = |marker: u8, body: &[u8]| {
        let length = (body.len() as u16 + 2).to_be_bytes();
        [&[0xff, marker], &length[..], body].concat()
    };
    let adobe = [b"Adobe\0\x64\0\0\0\0", &[transform][..]].concat();
    // The mean of a block is its first coefficient divided by 8.
    let quantization = [vec![0], vec![8; 64]].concat();
    let components: Vec<u8> = (1..=4).flat_map(|id| [id, 0x11, 0]).collect();
    let frame = [vec![8, 0, 8, 0, 8, 4], components].concat();
    // Nine sizes of differences, with codes of four bits; and the end of a block, with a code of one.
    let differences = [vec![0x00, 0, 0, 0, 9], vec![0; 12], (0..9).collect()].concat();
    let others = [vec![0x10, 1], vec![0; 15], vec![0]].concat();
    let scan = [
        vec![4],
        (1..=4).flat_map(|id| [id, 0]).collect(),
        vec![0, 63, 0],
    ]
    .concat();
    let mut bits = String::new();
    for value in stored {
        let difference = i32::from(value) - 128;
        let size = (32 - difference.unsigned_abs().leading_zeros()) as usize;
        let code = if difference < 0 {
            difference + (1 << size) - 1
        } else {
            difference
        };
        bits += &format!("{size:04b}");
        if size > 0 {
            bits += &format!("{code:0size$b}");
        }
        bits += "0";
    }
    bits += &"1".repeat((8 - bits.len() % 8) % 8);
    let bytes = bits.as_bytes().chunks(8).flat_map(|byte| {
        let byte = u8::from_str_radix(std::str::from_utf8(byte).unwrap(), 2).unwrap();
        if byte == 0xff {
            vec![0xff, 0]
        } else {
            vec![byte]
        }
    });
    let data: Vec<u8> = bytes.collect();
    [
        vec![0xff, 0xd8],
        segment(0xee, &adobe),
        segment(0xdb, &quantization),
        segment(0xc0, &frame),
        segment(0xc4, &differences),
        segment(0xc4, &others),
        segment(0xda, &scan),
        data,
        vec![0xff, 0xd9],
    ]
    .concat()
}

/// Inks are stored inverted: no cyan, half of the magenta, all of the yellow, no black, which is orange.
#[test]
fn inks_are_colours() {
    for (name, bytes, expected) in [
        ("CMYK", jpeg([255, 128, 0, 255], 0), [255, 128, 0]),
        ("CMYK with black", jpeg([255, 128, 0, 128], 0), [128, 64, 0]),
        // The inverse of orange as luma and chroma.
        ("YCCK", jpeg([104, 213, 54, 255], 2), [255, 128, 0]),
        (
            "YCCK with black",
            jpeg([104, 213, 54, 128], 2),
            [128, 64, 0],
        ),
    ] {
        let mtl = b"newmtl m\nmap_Kd a.jpg\n".to_vec();
        let scene =
            try_import(&[("a.obj", TRIANGLE.into()), ("a.mtl", mtl), ("a.jpg", bytes)]).unwrap();
        assert!(
            !warns(&scene, "", "cannot be read"),
            "{name}: {:?}",
            scene.warnings
        );
        let Texels::Rgba8(texels) = &scene.images[0].texels else {
            panic!("8 bits")
        };
        for (found, expected) in texels[0].into_iter().zip(expected) {
            assert!(found.abs_diff(expected) <= 3, "{name}: {:?}", texels[0]);
        }
    }
}
