//! Where names stand in a picture, so that none is on another.

/// A rectangle: its least and its greatest corner.
pub type Rectangle = [[f64; 2]; 2];

/// Where a text stands: what of it is at a point (`start`, `middle`, `end`), and the point, on its base line.
pub type Place = (&'static str, [f64; 2]);

/// Breadth of a letter and height of a line, in units of a font's size, at most.
const LETTER: [f64; 2] = [0.64, 0.8];

/// What a text takes in a font of this size.
pub fn extent(text: &str, (anchor, [x, y]): Place, size: f64) -> Rectangle {
    let width = LETTER[0] * size * text.chars().count() as f64;
    let left = match anchor {
        "end" => x - width,
        "middle" => x - width / 2.0,
        _ => x,
    };
    [[left, y - LETTER[1] * size], [left + width, y + 2.0]]
}

/// A rectangle about a point.
pub fn about([x, y]: [f64; 2], [across, up]: [f64; 2]) -> Rectangle {
    [[x - across, y - up], [x + across, y + up]]
}

/// Whether two rectangles have points in common.
pub fn meet(a: &Rectangle, b: &Rectangle) -> bool {
    (0..2).all(|k| a[0][k] < b[1][k] && b[0][k] < a[1][k])
}

/// Whether a rectangle meets the straight line between two points.
fn is_crossed(rectangle: &Rectangle, [from, to]: &[[f64; 2]; 2]) -> bool {
    let mut part = [0.0_f64, 1.0];
    for k in 0..2 {
        let step = to[k] - from[k];
        let ends = rectangle.map(|corner| corner[k] - from[k]);
        if step == 0.0 {
            if ends[0] >= 0.0 || ends[1] <= 0.0 {
                return false;
            }
        } else {
            let [a, b] = ends.map(|end| end / step);
            part = [part[0].max(a.min(b)), part[1].min(a.max(b))];
        }
    }
    part[0] < part[1]
}

/// What is in a picture already.
#[derive(Default)]
pub struct Taken {
    /// Names and marks.
    pub names: Vec<Rectangle>,
    /// Lines, which a name had rather not be on.
    pub lines: Vec<[[f64; 2]; 2]>,
}

impl Taken {
    /// Whether a name there is on no other.
    pub fn is_free(&self, rectangle: &Rectangle) -> bool {
        self.names.iter().all(|other| !meet(other, rectangle))
    }

    /// The first of the places at which a text is on nothing, or else on least, which it then takes.
    pub fn put(&mut self, text: &str, places: &[Place], size: f64, within: &Rectangle) -> Place {
        let cost = |place: &Place| {
            let own = extent(text, *place, size);
            let is_out = (0..2).any(|k| own[0][k] < within[0][k] || own[1][k] > within[1][k]);
            let on = self.names.iter().filter(|other| meet(other, &own)).count();
            let crossed = self.lines.iter().filter(|line| is_crossed(&own, line)).count();
            100 * (on + usize::from(is_out)) + crossed
        };
        let best = places.iter().min_by_key(|place| cost(place));
        let best = *best.unwrap_or(&("start", [0.0; 2]));
        self.names.push(extent(text, best, size));
        best
    }
}

/// Places beside a point, so far from it.
pub fn beside([x, y]: [f64; 2], off: f64) -> [Place; 6] {
    [
        ("start", [x + off, y - off + 2.0]),
        ("start", [x + off, y + off + 6.0]),
        ("end", [x - off, y - off + 2.0]),
        ("end", [x - off, y + off + 6.0]),
        ("middle", [x, y - off - 2.0]),
        ("middle", [x, y + off + 10.0]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const PICTURE: Rectangle = [[0.0, 0.0], [100.0, 100.0]];

    #[test]
    fn names_at_one_point_are_on_different_sides() {
        let mut taken = Taken::default();
        let places = [0; 3].map(|_| taken.put("leg", &beside([50.0, 50.0], 8.0), 10.0, &PICTURE));
        for (i, one) in taken.names.iter().enumerate() {
            assert!(taken.names[..i].iter().all(|other| !meet(one, other)), "{places:?}");
        }
    }

    #[test]
    fn a_name_is_within_the_picture_and_not_on_a_line() {
        let mut taken = Taken { lines: vec![[[0.0, 45.0], [90.0, 45.0]]], ..Taken::default() };
        let (anchor, at) = taken.put("corner", &beside([98.0, 50.0], 8.0), 10.0, &PICTURE);
        assert_eq!(anchor, "end");
        assert!(at[1] > 50.0);
    }
}
