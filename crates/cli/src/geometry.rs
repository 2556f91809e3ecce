//! The place of an input as JSON: in part files and for `info`.

use serde_json::{Value, json};
use tigereye_io::volume::PlaneGeometry;

/// The place as an object; null where the input lies nowhere.
pub(crate) fn to_json(geometry: &PlaneGeometry) -> Value {
    if !geometry.is_placed() {
        return Value::Null;
    }
    json!({
        "corner": geometry.corner(),
        "right": geometry.right(),
        "up": geometry.up(),
        "spacing": geometry.spacing(),
    })
}

/// The place of such an object, in the same bits; `None` for another object. Null or a missing value means no position.
pub(crate) fn from_json(value: Option<&Value>) -> Option<PlaneGeometry> {
    let Some(value) = value.filter(|v| !v.is_null()) else { return Some(PlaneGeometry::UNPLACED) };
    let geometry = PlaneGeometry::new(
        numbers(value, "corner")?,
        numbers(value, "right")?,
        numbers(value, "up")?,
        numbers(value, "spacing")?,
    );
    geometry.is_placed().then_some(geometry)
}

fn numbers<const N: usize>(value: &Value, key: &str) -> Option<[f64; N]> {
    let list: Option<Vec<f64>> = value.get(key)?.as_array()?.iter().map(Value::as_f64).collect();
    list?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_come_back_in_the_same_bits() {
        let third = 1.0 / 3.0;
        let placed =
            PlaneGeometry::new([0.1, -1e300, 5e-324], [third, 0.2, 0.3], [0.7, third, 0.1], [third, 3.1]);
        for geometry in [placed, PlaneGeometry::UNPLACED] {
            let text = to_json(&geometry).to_string();
            let value: Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(from_json(Some(&value)), Some(geometry));
        }
        assert_eq!(from_json(None), Some(PlaneGeometry::UNPLACED));
        assert_eq!(from_json(Some(&json!({ "corner": [1, 2] }))), None);
        assert_eq!(from_json(Some(&json!("there"))), None);
    }
}
