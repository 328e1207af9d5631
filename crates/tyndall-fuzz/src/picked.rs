//! A technique and its parameters, drawn from the library's own table.

use tyndall::techniques::{ParamInfo, TABLE, Technique, Value};

use crate::draw::Draw;

/// Whole numbers for parameters; larger ones only make the same loops longer.
const WHOLE: [i64; 14] = [
    1,
    2,
    3,
    4,
    0,
    5,
    16,
    64,
    100,
    128,
    256,
    -1,
    1 << 40,
    i64::MIN,
];

/// A technique with up to three of its parameters set; values that it refuses leave them as they are.
pub(crate) fn technique(draw: &mut Draw<'_>) -> Technique {
    let mut technique = draw.one_of(TABLE).default_technique();
    for _ in 0..draw.below(4) {
        let params = technique.params();
        if params.is_empty() {
            break;
        }
        let param = draw.one_of(&params).clone();
        let value = value(draw, &param);
        let _refused = technique.set(param.key, &value);
    }
    technique
}

fn value(draw: &mut Draw<'_>, param: &ParamInfo) -> Value {
    match param.default {
        Value::Integer(_) => Value::Integer(*draw.one_of(&WHOLE)),
        Value::Real(_) => Value::Real(draw.positive().into()),
        Value::Bool(_) => Value::Bool(draw.once_in(2)),
        Value::Word(_) => {
            let is_word = |c: char| c.is_alphanumeric() || c == '-';
            let words: Vec<&str> = param
                .range
                .split(|c| !is_word(c))
                .filter(|word| !word.is_empty())
                .collect();
            Value::Word((*draw.one_of(&words)).to_owned())
        }
    }
}
