//! JSON that breaks the rules of glTF in ways that leave no doubt about what is meant.

use gltf::json::Value;
use serde_json::Number;

/// Members that are indices of other elements.
const INDICES: [&str; 13] = [
    "bufferView",
    "buffer",
    "camera",
    "indices",
    "input",
    "material",
    "mesh",
    "output",
    "sampler",
    "scene",
    "skeleton",
    "skin",
    "source",
];

/// How often each kind of repair was made.
#[derive(Default)]
struct Repairs {
    whole_numbers: usize,
    nulls: usize,
    zeros: usize,
    negative_indices: usize,
}

/// Repairs it, and says what was done.
pub(super) fn repair(root: &mut Value) -> Vec<String> {
    let mut remarks = Vec::new();
    if let Some(version) = root.pointer_mut("/asset/version")
        && let Some(number) = version.as_f64()
    {
        *version = format!("{number:.1}").into();
        remarks.push("asset/version is a number, and read as text".to_owned());
    }
    let mut repairs = Repairs::default();
    repairs.visit(root);
    let mut remark = |count: usize, what: &str| {
        if count > 0 {
            remarks.push(format!("{count} × {what}"));
        }
    };
    remark(
        repairs.whole_numbers,
        "a whole number is written as a fraction (4.0); read as whole",
    );
    remark(repairs.nulls, "a member is null; read as absent");
    remark(
        repairs.zeros,
        "a number in an array is null or none; read as 0",
    );
    remark(
        repairs.negative_indices,
        "an index is negative; read as absent",
    );
    remarks
}

impl Repairs {
    /// The parser has bounded the depth.
    fn visit(&mut self, value: &mut Value) {
        match value {
            Value::Number(number) => {
                if let Some(whole) = whole(number) {
                    *number = whole;
                    self.whole_numbers += 1;
                }
            }
            Value::Array(items) => {
                for item in items {
                    if item.is_null() {
                        *item = 0.into();
                        self.zeros += 1;
                    }
                    self.visit(item);
                }
            }
            Value::Object(members) => {
                let before = members.len();
                members.retain(|_, member| !member.is_null());
                self.nulls += before - members.len();
                let before = members.len();
                members.retain(|name, member| {
                    let is_negative = member.as_i64().is_some_and(|index| index < 0);
                    !(is_negative && INDICES.contains(&name.as_str()))
                });
                self.negative_indices += before - members.len();
                members.values_mut().for_each(|member| self.visit(member));
            }
            Value::Null | Value::Bool(_) | Value::String(_) => {}
        }
    }
}

/// A number that is whole, but not written so.
fn whole(number: &Number) -> Option<Number> {
    const EXACT: f64 = (1_u64 << 53) as f64;
    let value = number.as_f64().filter(|_| number.is_f64())?;
    (value.fract() == 0.0 && value.abs() <= EXACT).then(|| Number::from(value as i64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_meant_is_read() {
        let mut value = serde_json::json!({
            "asset": {"version": 2.0, "generator": null},
            "accessors": [{"count": 4.0, "max": [1.5, null]}],
            "nodes": [{"mesh": -1, "rotation": [0.0, -1.0, 0.0, 0.5]}],
        });
        let remarks = repair(&mut value);
        let expected = serde_json::json!({
            "asset": {"version": "2.0"},
            "accessors": [{"count": 4, "max": [1.5, 0]}],
            "nodes": [{"rotation": [0, -1, 0, 0.5]}],
        });
        assert_eq!(value, expected);
        assert_eq!(remarks.len(), 5, "{remarks:?}");
    }

    #[test]
    fn what_is_right_is_left_alone() {
        let right = serde_json::json!({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0, "scale": [1, 2.5, 1]}]});
        let mut value = right.clone();
        assert!(repair(&mut value).is_empty());
        assert_eq!(value, right);
    }
}
