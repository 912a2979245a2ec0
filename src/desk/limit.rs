//! How far one number of a design goes.

use crate::questions::{design, run};
use num_rational::BigRational;
use orthocert::design::Variable;
use orthocert::exact::decimal::exact;
use orthocert::exact::Exact;
use orthocert::questions::limit::{
    limits, Decided, DesignFamily, Direction, Family, Limit, Place, Question, Side,
};
use orthocert_checker::certificate::Certificate;
use serde_json::{json, Value};

/// Boxes after which a value counts as undecided.
const MOST_BOXES: usize = 20_000;
/// The relative distance of a certified and a refuted value, one in so many.
const GAP: i64 = 10_000;
/// Fractional bits in which an irrational number is compared with others.
const BITS: u32 = 192;

/// The limits of a number, each a certified value and a refuted one.
pub fn limit(text: &str, file: &str, key: &str) -> Result<Value, String> {
    let claim = design(text, file)?.claim;
    let variable = &Variable::find(text, file, key).map_err(|error| error.to_string())?;
    let own = variable.own();
    let question = Question {
        own: own.as_rational().cloned().or_else(|| own.below(BITS)).ok_or(TOO_LONG)?,
        size: variable.size().clone(),
        gap: BigRational::new(1.into(), GAP.into()),
        directions: vec![Direction::Down, Direction::Up],
        deadline: None,
    };
    let found = run(|control| {
        let mut family = DesignFamily { variable, max_boxes: MOST_BOXES, control };
        let own = family.decide(&claim, [0.0, 1.0], None)?;
        limits(&question, own, &mut family)
    });
    let found = found.map_err(|error| error.to_string())?;
    let rows: Vec<Value> = found.iter().map(|limit| row(&question, limit)).collect();
    Ok(json!({ "key": key, "own": exact(own), "limits": rows }))
}

/// As the command line says it.
const TOO_LONG: &str = "the design's numbers exceed what can be reported";

fn row(question: &Question, limit: &Limit<Box<Certificate>>) -> Value {
    let value = |end: &Option<Decided<Box<Certificate>>>| {
        end.as_ref().map(|end| exact(&Exact::Rational(end.value.clone())))
    };
    let ends =
        |ends: &[BigRational; 2]| ends.each_ref().map(|x| exact(&Exact::Rational(x.clone())));
    json!({
        "side": match limit.side { Side::Lower => "lower", Side::Upper => "upper" },
        "certified": value(&limit.certified),
        "refuted": value(&limit.refuted),
        "place": limit.refuted.as_ref().and_then(|refuted| Place::of(&refuted.proof)),
        "undecided": limit.undecided.as_ref().map(ends),
        "end": limit.end.as_ref().map(|end| &end.reason),
        "open": question.is_open(limit),
    })
}
