//! How a result came about, as the JSON object that every written volume carries.

use serde_json::{Value, json};
use tigereye_core::{Field, Tensor2};
use tigereye_io::Rows;

/// Version of the program that makes the results.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The JSON object: `version`, `command`, `parameters`, `input_blake3` (hex).
#[must_use]
pub fn provenance(command: &str, parameters: &Value, input_blake3: &str) -> String {
    json!({ "version": VERSION, "command": command, "parameters": parameters, "input_blake3": input_blake3 })
        .to_string()
}

/// Parameters with the way in which the rows of a written image run.
#[must_use]
pub fn with_rows(mut parameters: Value, rows: Rows) -> Value {
    if let Some(all) = parameters.as_object_mut() {
        all.insert(Rows::KEY.to_owned(), Value::from(rows.name()));
    }
    parameters
}

/// Hash of the bytes of an input file, hex.
#[must_use]
pub fn hash_of_bytes(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// Hash of a field that no file holds: width, height (u64) and the components row by row (f64), little endian, hex.
#[must_use]
pub fn hash_of_field(field: &Field<Tensor2>) -> String {
    let mut hasher = blake3::Hasher::new();
    for side in [field.grid().width(), field.grid().height()] {
        hasher.update(&(side as u64).to_le_bytes());
    }
    for component in field.values().iter().flat_map(Tensor2::components) {
        hasher.update(&component.to_le_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::Grid;

    #[test]
    fn hash_sees_every_component() {
        let grid = Grid::new(2, 1).expect("a grid");
        let a = Field::from_fn(grid, |_| Tensor2::IDENTITY);
        let mut b = a.clone();
        b.values_mut()[1] = Tensor2::new(1.0, 0.0, 1e-300, 1.0);
        assert_ne!(hash_of_field(&a), hash_of_field(&b));
        assert_eq!(hash_of_field(&a).len(), 64);
    }

    #[test]
    fn provenance_is_one_json_object() {
        let text = provenance("tigereye ltg x", &json!({ "directions": 32 }), "00");
        let value: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(value["parameters"]["directions"], 32);
    }
}
