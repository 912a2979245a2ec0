//! Reading nothing but the format: derived readers also take an array of the fields' values, in
//! order, for an object, `null` for what is absent, and objects for names; the format does not.

use crate::certificate::{MAX_LABEL, MAX_NODES, MAX_STEPS};
use crate::number::Exact;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// The first byte, with its place, that no text of the format has outside its strings: there are
/// no literals (`null`, `true`, `false`) and no numbers but integers in it.
pub(crate) fn foreign_byte(text: &str) -> Option<(usize, char)> {
    let (mut in_string, mut escaped) = (false, false);
    for (at, c) in text.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' if in_string => escaped = true,
            '"' => in_string = !in_string,
            '{' | '}' | '[' | ']' | ':' | ',' | '-' | '0'..='9' | ' ' | '\t' | '\n' | '\r' => {}
            _ if in_string => {}
            _ => return Some((at, c)),
        }
    }
    None
}

struct Object<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for Object<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<T, M::Error> {
        T::deserialize(MapAccessDeserializer::new(map))
    }
}

/// Reads a `T` from an object, and from nothing else.
pub(crate) fn object<'de, D, T>(deserializer: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    deserializer.deserialize_map(Object(PhantomData))
}

/// A `T` that is read by [`object`].
pub(crate) struct Strict<T>(pub T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Strict<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        object(deserializer).map(Strict)
    }
}

struct List<T> {
    most: usize,
    items: PhantomData<T>,
}

impl<'de, T: Deserialize<'de>> Visitor<'de> for List<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an array")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Vec<T>, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element()? {
            if list.len() == self.most {
                return Err(A::Error::custom(format!("more than {} elements", self.most)));
            }
            list.push(item);
        }
        Ok(list)
    }
}

fn list<'de, D, T>(deserializer: D, most: usize) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    deserializer.deserialize_seq(List { most, items: PhantomData })
}

fn objects<'de, D, T>(deserializer: D, most: usize) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let strict: Vec<Strict<T>> = list(deserializer, most)?;
    Ok(strict.into_iter().map(|Strict(item)| item).collect())
}

/// Reads an array of at most [`MAX_NODES`] objects.
pub(crate) fn nodes<'de, D, T>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    objects(deserializer, MAX_NODES)
}

/// Reads an array of at most [`MAX_STEPS`] names or objects.
pub(crate) fn steps<'de, D, T>(deserializer: D) -> Result<Vec<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let mut steps = list(deserializer, MAX_STEPS)?;
    // There may be many short lists: none keeps room to grow.
    let mut exact = Vec::with_capacity(steps.len());
    exact.append(&mut steps);
    Ok(exact)
}

/// Reads a value without fields by its name: from a string, and from nothing else.
pub(crate) fn name<'de, D, T>(deserializer: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let text = Cow::<'de, str>::deserialize(deserializer)?;
    T::deserialize(text.as_ref().into_deserializer())
}

/// Reads a string that can be shown as it is.
pub(crate) fn label<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let text = Cow::<'de, str>::deserialize(deserializer)?;
    if text.len() > MAX_LABEL || !text.bytes().all(|byte| matches!(byte, b' '..=b'~')) {
        let limit = format!("a string of more than {MAX_LABEL} bytes, or not printable ASCII");
        return Err(D::Error::custom(limit));
    }
    Ok(text.into_owned())
}

/// Reads three objects.
pub(crate) fn three<'de, D, T>(deserializer: D) -> Result<[T; 3], D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let three: [Strict<T>; 3] = Deserialize::deserialize(deserializer)?;
    Ok(three.map(|Strict(item)| item))
}

/// Reads a point: rational numbers, so that what proofs add to a claim's numbers has no roots.
pub(crate) fn point<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[Exact; 3], D::Error> {
    let point: [Exact; 3] = Deserialize::deserialize(deserializer)?;
    match point.iter().all(|x| x.as_rational().is_some()) {
        true => Ok(point),
        false => Err(D::Error::custom("a point is not three rational numbers")),
    }
}

/// Reads an optional object.
pub(crate) fn optional<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let item: Strict<T> = Deserialize::deserialize(deserializer)?;
    Ok(Some(item.0))
}

/// Reads three optional objects.
pub(crate) fn optional_three<'de, D, T>(deserializer: D) -> Result<Option<[T; 3]>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    three(deserializer).map(Some)
}
