//! Where a function on a rectangle is at least of a level, as polygons.

use glam::DVec2;
use rustc_hash::FxHashMap;

/// Values on a grid of lines that need not be equally far apart.
pub(super) struct Field {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Row by row.
    values: Vec<f64>,
}

/// An edge of the grid's triangles: its first corner, and whether it leads right, up, or both.
type Edge = (usize, usize, u8);

impl Field {
    /// By a function that is nowhere negative, on ascending lines.
    pub(super) fn new(x: Vec<f64>, y: Vec<f64>, f: impl Fn(DVec2) -> f64) -> Self {
        let values = y.iter().flat_map(|&y| x.iter().map(move |&x| DVec2::new(x, y))).map(f).collect();
        Self { x, y, values }
    }

    pub(super) fn max(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }

    /// With a row more all around, outside of which there is nothing.
    fn at(&self, i: usize, j: usize) -> f64 {
        let (columns, rows) = (self.x.len(), self.y.len());
        let is_inside = (1..=columns).contains(&i) && (1..=rows).contains(&j);
        if is_inside { self.values[(j - 1) * columns + i - 1] } else { -1.0 }
    }

    fn place(&self, i: usize, j: usize) -> DVec2 {
        let within = |k: usize, count: usize| k.clamp(1, count) - 1;
        DVec2::new(self.x[within(i, self.x.len())], self.y[within(j, self.y.len())])
    }

    /// The closed curves around all that is at least of a positive level, linear in between: with the even-odd rule they are that region.
    pub(super) fn at_least(&self, level: f64) -> Vec<Vec<DVec2>> {
        let mut next: FxHashMap<Edge, Edge> = FxHashMap::default();
        // In an order that is always the same.
        let mut starts = Vec::new();
        for j in 0..=self.y.len() {
            for i in 0..=self.x.len() {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                for [a, b, c] in [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]] {
                    if let Some((from, to)) = self.segment([a, b, c], level) {
                        next.insert(from, to);
                        starts.push(from);
                    }
                }
            }
        }
        let mut loops = Vec::new();
        for start in starts {
            let mut points = Vec::new();
            let mut edge = start;
            while let Some(following) = next.remove(&edge) {
                points.push(self.crossing(edge, level));
                edge = following;
            }
            if points.len() > 2 {
                loops.push(points);
            }
        }
        loops
    }

    /// From where the level is crossed on one side of a counter-clockwise triangle to where it is on another, with what is above to the left.
    fn segment(&self, corners: [(usize, usize); 3], level: f64) -> Option<(Edge, Edge)> {
        let above = corners.map(|(i, j)| self.at(i, j) >= level);
        // The corner that is alone.
        let alone = (0..3).find(|&k| above[k] != above[(k + 1) % 3] && above[k] != above[(k + 2) % 3])?;
        let [out, back] =
            [edge(corners[alone], corners[(alone + 1) % 3]), edge(corners[(alone + 2) % 3], corners[alone])];
        Some(if above[alone] { (out, back) } else { (back, out) })
    }

    fn crossing(&self, (i, j, kind): Edge, level: f64) -> DVec2 {
        let (k, l) = (i + usize::from(kind != 1), j + usize::from(kind != 0));
        let [a, b] = [self.at(i, j), self.at(k, l)];
        self.place(i, j).lerp(self.place(k, l), ((level - a) / (b - a)).clamp(0.0, 1.0))
    }
}

fn edge((i, j): (usize, usize), (k, l): (usize, usize)) -> Edge {
    let kind = if j == l {
        0
    } else if i == k {
        1
    } else {
        2
    };
    (i.min(k), j.min(l), kind)
}

#[cfg(test)]
mod tests {
    use super::Field;
    use glam::DVec2;
    use std::f64::consts::PI;

    fn area(loops: &[Vec<DVec2>]) -> f64 {
        let double = |points: &Vec<DVec2>| -> f64 {
            points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum()
        };
        loops.iter().map(double).sum::<f64>() / 2.0
    }

    #[test]
    fn discs_rings_and_what_is_cut_off() {
        let lines: Vec<f64> = (0..=200).map(|k| f64::from(k) / 100.0 - 1.0).collect();
        let field = Field::new(lines.clone(), lines, |p| 2.0 - p.length());
        let disc = field.at_least(1.5);
        assert!(disc.len() == 1 && (area(&disc) - PI / 4.0).abs() < 1e-3, "{}", area(&disc));
        // All of it: the border of the grid.
        assert!((area(&field.at_least(0.1)) - 4.0).abs() < 1e-12);
        // Cut off by the border: the square without its corners.
        let cut = area(&field.at_least(0.9));
        let expected = PI * 1.21 - 4.0 * (1.21 * (1.0_f64 / 1.1).acos() - (1.21_f64 - 1.0).sqrt());
        assert!((cut - expected).abs() < 1e-3, "{cut} {expected}");
        assert!(field.at_least(2.1).is_empty());
        let lines: Vec<f64> = (0..=200).map(|k| f64::from(k) / 100.0 - 1.0).collect();
        let ring = Field::new(lines.clone(), lines, |p| 1.0 - (p.length() - 0.6).abs()).at_least(0.8);
        let expected = PI * (0.64 - 0.16);
        assert!(ring.len() == 2 && (area(&ring) - expected).abs() < 2e-3, "{}", area(&ring));
    }
}
