//! Radiance pictures, written by hand and by another encoder.

use super::radiance::{Header, header, is_radiance, texels};

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
fn other_primaries_are_converted() {
    let with = |lines: &str| {
        let mut bytes = format!("#?RADIANCE\n{lines}\n-Y 1 +X 2\n").into_bytes();
        bytes.extend([128, 128, 128, 129, 64, 128, 64, 129]);
        let (header, texels) = decode(&bytes).unwrap();
        (texels, header.remarks)
    };
    let rec_2020 = "PRIMARIES=0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329\n";
    let (texels, remarks) = with(rec_2020);
    // ITU-R BT.2087, inverse; white stays white.
    let green = [
        1.6605 * 0.5 - 0.5876 - 0.0728 * 0.5,
        -0.1246 * 0.5 + 1.1329 - 0.0083 * 0.5,
        -0.0182 * 0.5 - 0.1006 + 1.1187 * 0.5,
    ];
    for (texel, expected) in texels.iter().zip([[1.0; 3], green]) {
        let mut pairs = texel.iter().zip(expected);
        assert!(
            pairs.all(|(a, b): (&f32, f32)| (a - b).abs() < 2e-4),
            "{texel:?} {expected:?}"
        );
    }
    assert!(remarks.is_empty(), "{remarks:?}");
    // Factors belong to the primaries of the file, and colours of the CIE have none.
    let (scaled, _) = with(&format!("COLORCORR=1 2 1\n{rec_2020}"));
    assert!(scaled[1][1] < texels[1][1]);
    let (cie, _) = with(&format!("FORMAT=32-bit_rle_xyze\n{rec_2020}"));
    assert_eq!(cie, with("FORMAT=32-bit_rle_xyze\n").0);
    for odd in [
        "0.64 0.33 0.64 0.33 0.15 0.06 0.3127 0.329",
        "0.64 0.33 0.3 0.6 0.15 0.06",
        "red green",
        "0.9 0.1 0.1 0.9 0.1 0.1 0 0",
    ] {
        let (texels, remarks) = with(&format!("PRIMARIES={odd}\n"));
        assert_eq!(texels[1][..3], [0.5, 1.0, 0.5], "{odd}");
        assert!(
            remarks[0].contains("make no sense; ignored"),
            "{odd}: {remarks:?}"
        );
    }
}

#[test]
fn the_first_line_may_be_missing() {
    for lines in [
        "FORMAT=32-bit_rle_rgbe\n",
        "# made by hand\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n",
        "EXPOSURE=1.0\n",
        "FORMAT=32-bit_rle_rgbe\r\n",
    ] {
        for resolution in ["-Y 1 +X 1", "+X 1 -Y 1"] {
            let mut bytes = format!("{lines}\n{resolution}\n").into_bytes();
            bytes.extend([64, 0, 0, 136]);
            assert!(is_radiance(&bytes), "{lines}");
            let (header, texels) = decode(&bytes).unwrap();
            assert_eq!(texels[0][0], 64.0, "{lines}");
            assert!(
                header.remarks[0].contains("lacks its first line"),
                "{:?}",
                header.remarks
            );
        }
    }
    let (header, _) = decode(&picture("", "-Y 1 +X 1", &[64])).unwrap();
    assert!(header.remarks.is_empty());
    for other in [
        &b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\n\n"[..],
        b"FORMAT=32-bit_rle_rgbe\n-Y 1 +X 1\n",
        b"P6\n1 1\n255\n\0\0\0",
        b"a text\n\n-Y 1\n",
        b"FORMAT=8-bit\n\n-Y 1 +X 1\n",
        b"",
    ] {
        assert!(!is_radiance(other), "{other:?}");
    }
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
