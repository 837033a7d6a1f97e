//! Radiance pictures, written by hand and by another encoder.

use super::radiance::{Header, header, texels};

fn decode(bytes: &[u8]) -> Result<(Header, Vec<[f32; 4]>), String> {
    let header = header(bytes)?;
    let texels = texels(bytes, &header)?;
    Ok((header, texels))
}

/// A picture whose pixels have exponents that give whole numbers: their red byte.
fn picture(lines: &str, resolution: &str, reds: &[u8]) -> Vec<u8> {
    let mut bytes = format!("#?RGBE\n{lines}\n{resolution}\n").into_bytes();
    bytes.extend(reds.iter().flat_map(|&red| [red, 0, 0, 136]));
    bytes
}

fn reds(bytes: &[u8]) -> Vec<f32> {
    let (_, texels) = decode(bytes).unwrap();
    texels.iter().map(|texel| texel[0]).collect()
}

#[test]
fn every_orientation_is_turned_upright() {
    // 11 12 13
    // 21 22 23
    let upright = [11.0, 12.0, 13.0, 21.0, 22.0, 23.0];
    for (resolution, stored) in [
        ("-Y 2 +X 3", [11, 12, 13, 21, 22, 23]),
        ("-Y 2 -X 3", [13, 12, 11, 23, 22, 21]),
        ("+Y 2 -X 3", [23, 22, 21, 13, 12, 11]),
        ("+Y 2 +X 3", [21, 22, 23, 11, 12, 13]),
        ("+X 3 -Y 2", [11, 21, 12, 22, 13, 23]),
        ("-X 3 -Y 2", [13, 23, 12, 22, 11, 21]),
        ("+X 3 +Y 2", [21, 11, 22, 12, 23, 13]),
        ("-X 3 +Y 2", [23, 13, 22, 12, 21, 11]),
    ] {
        let bytes = picture("FORMAT=32-bit_rle_rgbe\n", resolution, &stored);
        let (header, _) = decode(&bytes).unwrap();
        assert_eq!((header.width, header.height), (3, 2), "{resolution}");
        assert_eq!(reds(&bytes), upright, "{resolution}");
    }
    for resolution in [
        "",
        "-Y 2",
        "-Y 2 +Y 3",
        "Y 2 X 3",
        "-Y two +X 3",
        "-Z 2 +X 3",
        "é é é é",
    ] {
        let problem = decode(&picture("", resolution, &[0; 6])).unwrap_err();
        assert!(problem.contains("orientation"), "{resolution}: {problem}");
    }
}

#[test]
fn factors_of_the_header_are_divided_by() {
    let with = |lines: &str| {
        let (header, texels) = decode(&picture(lines, "-Y 1 +X 1", &[64])).unwrap();
        (texels[0][0], header.remarks.join(""))
    };
    assert_eq!(with(""), (64.0, String::new()));
    assert_eq!(with("EXPOSURE=4\n").0, 16.0);
    assert_eq!(with("EXPOSURE= 4.0\r\nsomething\nEXPOSURE=0.5\n").0, 32.0);
    assert_eq!(with("COLORCORR= 2 1 1\nEXPOSURE=2\n").0, 16.0);
    for primaries in [
        "0 0 0 0 0 0 0 0",
        "0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333",
    ] {
        assert_eq!(with(&format!("PRIMARIES={primaries}\n")).1, "");
    }
    assert!(
        with("PRIMARIES=0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329\n")
            .1
            .contains("ignored")
    );
    assert_eq!(
        with("# EXPOSURE=4\nVIEW= -vtl\nPIXASPECT=2\n"),
        (64.0, String::new())
    );
    for odd in [
        "EXPOSURE=0\n",
        "EXPOSURE=-1\n",
        "EXPOSURE=no\n",
        "COLORCORR=1\n",
        "GAMMA=2.2\n",
    ] {
        let (red, remarks) = with(odd);
        assert!(
            red == 64.0 && remarks.contains("ignored"),
            "{odd}: {red} {remarks}"
        );
    }
    assert!(decode(&picture("FORMAT=16-bit\n", "-Y 1 +X 1", &[64])).is_err());
}

#[test]
fn white_of_the_cie_is_white() {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n".to_vec();
    bytes.extend([128, 128, 128, 129, 0, 128, 0, 129]);
    let (_, texels) = decode(&bytes).unwrap();
    for channel in &texels[0] {
        assert!((channel - 1.0).abs() < 1e-6, "{texels:?}");
    }
    // Luminance alone is a green that no display has.
    assert!(texels[1][0] < 0.0 && texels[1][1] > 1.9);
}

#[test]
fn runs_of_both_kinds_are_read() {
    let header = b"#?RADIANCE\n\n-Y 1 +X 10\n";
    let [a, b] = [[7, 8, 9, 136], [5, 0, 1, 136]];
    let pixels = |bytes: &[u8]| {
        let bytes = [header, bytes].concat();
        decode(&bytes).map(|(_, texels)| texels.iter().map(|texel| texel[0]).collect::<Vec<_>>())
    };
    let expected = [7.0, 7.0, 7.0, 7.0, 7.0, 7.0, 7.0, 5.0, 5.0, 5.0];
    let flat: Vec<u8> = [[a; 7].as_flattened(), [b; 3].as_flattened()].concat();
    assert_eq!(pixels(&flat).unwrap(), expected);
    let old = [a, [1, 1, 1, 6], b, [1, 1, 1, 2]].concat();
    assert_eq!(pixels(&old).unwrap(), expected);
    let digits = [a, [1, 1, 1, 6], [1, 1, 1, 0], b, b, b].concat();
    assert_eq!(pixels(&digits).unwrap(), expected);
    let channel = |a: u8, b: u8| [128 + 7, a, 3, b, b, b];
    let runs: Vec<u8> = (0..4).flat_map(|k| channel(a[k], b[k])).collect();
    let channelwise = [&[2, 2, 0, 10], &runs[..]].concat();
    assert_eq!(pixels(&channelwise).unwrap(), expected);
    // Damage of any kind is an error.
    for bytes in [&flat, &old, &digits, &channelwise] {
        for length in 0..bytes.len() {
            assert!(pixels(&bytes[..length]).is_err(), "{length}");
        }
    }
    for bytes in [
        [[1, 1, 1, 1]; 10].as_flattened(),
        [a, [1, 1, 1, 10]].as_flattened(),
        [
            a,
            [1, 1, 1, 0],
            [1, 1, 1, 0],
            [1, 1, 1, 0],
            [1, 1, 1, 0],
            [1, 1, 1, 255],
            [1, 1, 1, 255],
            [1, 1, 1, 255],
        ]
        .as_flattened(),
        &[2, 2, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0],
        &[
            2,
            2,
            0,
            10,
            128 + 11,
            1,
            128 + 10,
            1,
            128 + 10,
            1,
            128 + 10,
            1,
        ],
    ] {
        assert!(pixels(bytes).is_err(), "{bytes:?}");
    }
}

#[test]
fn pictures_of_another_encoder_have_its_values() {
    let (width, height) = (37, 5);
    let mut state = 1_u32;
    let mut number = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        // Few values, so that there are runs.
        (state >> 28) as f32 * 0.37 * f32::powi(2.0, (state >> 24 & 7) as i32 - 4)
    };
    let pixels: Vec<_> = (0..width * height)
        .map(|_| image::Rgb([number(), number(), number()]))
        .collect();
    let mut bytes = Vec::new();
    image::codecs::hdr::HdrEncoder::new(&mut bytes)
        .encode(&pixels, width, height)
        .unwrap();
    let (_, texels) = decode(&bytes).unwrap();
    let expected = image::load_from_memory(&bytes).unwrap().into_rgba32f();
    assert_eq!(texels.as_flattened(), expected.into_raw());
}
