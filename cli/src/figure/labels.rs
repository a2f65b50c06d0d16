//! Labels that keep out of each other's way.

/// A box of pixels: left, top, right, bottom.
pub(crate) type Box4 = (i32, i32, i32, i32);

/// Where labels have been put.
#[derive(Default)]
pub(crate) struct Labels {
    taken: Vec<Box4>,
}

impl Labels {
    /// The first of several places (the middle of the text) where a text of this size is free, which it takes; none
    /// where all are taken.
    pub fn place(
        &mut self,
        places: impl IntoIterator<Item = (i32, i32)>,
        (width, height): (i32, i32),
    ) -> Option<(i32, i32)> {
        for (x, y) in places {
            let wanted = (x - width / 2, y - height / 2, x + width / 2, y + height / 2);
            if !self.taken.iter().any(|taken| overlap(*taken, wanted)) {
                self.taken.push(wanted);
                return Some((x, y));
            }
        }
        None
    }
}

fn overlap(a: Box4, b: Box4) -> bool {
    a.0 < b.2 && b.0 < a.2 && a.1 < b.3 && b.1 < a.3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_label_moves_to_the_next_row_and_a_third_is_left_out() {
        let mut labels = Labels::default();
        let rows = [(0, 0), (0, 30)];
        let placed: Vec<_> = (0..3).map(|_| labels.place(rows, (20, 20))).collect();
        assert_eq!(placed, [Some((0, 0)), Some((0, 30)), None]);
    }
}
