//! Things by row and column, of which whole rows are forgotten from the top.

use std::collections::VecDeque;

/// Things at places of a lattice that lie close together.
pub(super) struct Rows<T> {
    top: u32,
    left: u32,
    rows: VecDeque<Vec<Option<T>>>,
}

impl<T> Default for Rows<T> {
    fn default() -> Self {
        Self { top: 0, left: 0, rows: VecDeque::new() }
    }
}

impl<T: Copy> Rows<T> {
    /// What is kept at a column and a row.
    #[inline]
    pub(super) fn get(&self, x: u32, y: u32) -> Option<T> {
        let row = self.rows.get(y.checked_sub(self.top)? as usize)?;
        *row.get(x.checked_sub(self.left)? as usize)?
    }

    /// Keeps something at a column and a row.
    pub(super) fn keep(&mut self, x: u32, y: u32, thing: T) {
        if self.rows.is_empty() {
            (self.left, self.top) = (x, y);
        }
        while y < self.top {
            self.rows.push_front(vec![]);
            self.top -= 1;
        }
        if x < self.left {
            let more = (self.left - x) as usize;
            for row in self.rows.iter_mut().filter(|row| !row.is_empty()) {
                row.splice(0..0, (0..more).map(|_| None));
            }
            self.left = x;
        }
        let (row, column) = ((y - self.top) as usize, (x - self.left) as usize);
        while self.rows.len() <= row {
            self.rows.push_back(vec![]);
        }
        let row = &mut self.rows[row];
        if row.len() <= column {
            row.resize(column + 1, None);
        }
        row[column] = Some(thing);
    }

    /// Forgets the rows above one.
    pub(super) fn forget_above(&mut self, y: u32) {
        while self.top < y && self.rows.pop_front().is_some() {
            self.top += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn what_is_kept_is_found_in_any_order_and_rows_above_are_forgotten() {
        let mut rows = Rows::default();
        let mut known = BTreeMap::new();
        for n in 0..500u32 {
            let (x, y) = (40 + n * 7919 % 23, 60 + n / 20 + n * 104_729 % 5);
            if n % 20 == 0 {
                rows.forget_above(60 + n / 20);
                known.retain(|(_, at), _| *at >= 60 + n / 20);
            }
            rows.keep(x, y, n);
            known.insert((x, y), n);
            for (x, y) in (38..66).flat_map(|x| (58..95).map(move |y| (x, y))) {
                assert_eq!(rows.get(x, y), known.get(&(x, y)).copied(), "{n}: {x}, {y}");
            }
        }
        rows.forget_above(1000);
        assert_eq!(rows.get(40, 84), None);
        rows.keep(3, 2, 1);
        assert_eq!(rows.get(3, 2), Some(1));
    }
}
