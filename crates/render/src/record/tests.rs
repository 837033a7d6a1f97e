//! Records are read as they were written.
#![expect(unreachable_pub, reason = "records are public")]

use super::*;
use crate::domain::{Scalar, Uint};
use crate::math::vec3::vec3;
use crate::scene_data::SceneData;

record! {
    /// Every kind of field, and a row with room at its end.
    pub struct Example in Params {
        row {
            /// A word.
            first: word,
            /// A vector behind it.
            second: vector,
        }
        row {
            /// A number.
            third: real,
        }
        row {
            /// A vector.
            fourth: vector,
            /// A word behind it.
            fifth: word,
        }
    }
}

fn example(seed: u32) -> Example {
    let real = |k: u32| (seed * 10 + k) as f32;
    Example {
        first: seed,
        second: vec3(real(1), real(2), real(3)),
        third: real(4),
        fourth: vec3(real(5), real(6), real(7)),
        fifth: seed + 8,
    }
}

#[test]
fn fields_lie_where_their_rows_say() {
    let [a, b, c, e] = [11.0_f32, 12.0, 13.0, 14.0].map(f32::to_bits);
    let [f, g, h] = [15.0_f32, 16.0, 17.0].map(f32::to_bits);
    let mut words = vec![99];
    example(1).append_to(&mut words);
    assert_eq!(words, [99, 1, a, b, c, e, 0, 0, 0, f, g, h, 9]);
    assert_eq!((Example::ROWS, Example::WORDS), (3, 12));
    let offsets = Example::offsets();
    assert_eq!(
        (offsets.first, offsets.second.to_array(), offsets.third),
        (0, [1, 2, 3], 4)
    );
    assert_eq!((offsets.fourth.to_array(), offsets.fifth), ([8, 9, 10], 11));
}

#[test]
fn what_was_written_is_read() {
    let mut data = SceneData::default();
    (0..5).for_each(|seed| data.push(example(seed)));
    data.change(3, |record: Example| Example {
        third: -1.0,
        ..record
    });
    let mut expected: Vec<Example> = (0..5).map(example).collect();
    expected[3].third = -1.0;
    assert!(data.records::<Example>().eq(expected.iter().copied()));

    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let plain = |record: Example<Scalar<'_>>| Example {
        first: record.first.0,
        second: record.second,
        third: record.third,
        fourth: record.fourth,
        fifth: record.fifth.0,
    };
    for (index, &record) in expected.iter().enumerate() {
        assert_eq!(data.record::<Example>(index), record);
        assert_eq!(plain(Example::load(d, Uint(index as u32))), record);
        let first = index as u32 * Example::WORDS;
        let buffer = Example::BUFFER;
        assert_eq!(plain(Example::load_at(d, buffer, Uint(first))), record);
        assert_eq!(plain(Example::uniform_at(d, buffer, first)), record);
    }
    assert_eq!(plain(Example::uniform(d)), expected[0]);
}
