//! How claims are written and read, where their form is not that of their types.

use super::Quantity;
use crate::number::Exact;
use crate::strict;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

// The fields of variants, read strictly: see `crate::strict`.

type Corners = ([Exact; 3], [Exact; 3]);

pub(super) fn corners<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Corners, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fields {
        min: [Exact; 3],
        max: [Exact; 3],
    }
    strict::object(deserializer).map(|Fields { min, max }| (min, max))
}

type CylinderFields = ([Exact; 2], Exact, [Exact; 2]);

pub(super) fn cylinder<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<CylinderFields, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fields {
        center: [Exact; 2],
        radius: Exact,
        z: [Exact; 2],
    }
    strict::object(deserializer).map(|Fields { center, radius, z }| (center, radius, z))
}

pub(super) fn side<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Exact, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fields {
        side: Exact,
    }
    strict::object(deserializer).map(|Fields { side }| side)
}

pub(super) fn offset<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Exact, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Fields {
        offset: Exact,
    }
    strict::object(deserializer).map(|Fields { offset }| offset)
}

impl Serialize for Exact {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Exact {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = std::borrow::Cow::<'de, str>::deserialize(deserializer)?;
        Exact::parse_canonical(&text).map_err(|e| D::Error::custom(format!("not a number: {e}")))
    }
}

impl Serialize for Quantity {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.is_exact() {
            return self.min.serialize(serializer);
        }
        Tolerance { min: self.min.clone(), max: self.max.clone() }.serialize(serializer)
    }
}

/// The form of a [`Quantity`] that is not a single number.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tolerance {
    min: Exact,
    max: Exact,
}

impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrTolerance)
    }
}

/// Reads a number or an object with `min` and `max`.
struct NumberOrTolerance;

impl<'de> Visitor<'de> for NumberOrTolerance {
    type Value = Quantity;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number as a string, or an object with min and max")
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Quantity, E> {
        Exact::parse_canonical(text)
            .map(Quantity::exactly)
            .map_err(|e| E::custom(format!("not a number: {e}")))
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<Quantity, M::Error> {
        let form = serde::de::value::MapAccessDeserializer::new(map);
        let Tolerance { min, max } = Tolerance::deserialize(form)?;
        if min == max {
            return Err(M::Error::custom("equal min and max are written as one number"));
        }
        Ok(Quantity { min, max })
    }
}
