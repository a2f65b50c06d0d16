//! Contacts of the rod past a contour that its recording tells apart.
//!
//! Noise makes shallow hollows in a contour. Where a contact passes over one, the rod past the contour touches both rims for a moment. If the recording does
//! not tell that the hollow is there, the two are told as the one contact that there would be without it.

use super::curve::{Curve, Dependent};
use crate::phase::Label;
use nalgebra::{DMatrix, Matrix2, Vector2};
use rod_contact::{Contact, ContactKind};

/// Depth of a hollow below which it may as well not be there, rod lengths and standard deviations of what is known of it. Smaller: noise makes contacts;
/// larger: contacts on either side of a true hollow are told as one.
const SHALLOW: f64 = 2e-3;
const KNOWN: f64 = 4.0;

/// A contact that is told, and the uncertainty of its place which comes from those that it stands for.
pub(super) struct Distinct {
    /// The contact of the state that it is most like.
    pub like: usize,
    pub contact: Contact,
    pub spread: Matrix2<f64>,
}

impl Curve {
    /// Those of the contacts of a state that can be told apart, with this covariance of the unknowns and for a rod of this length.
    pub fn distinct(&self, contacts: &[Contact], covariance: &DMatrix<f64>, length: f64) -> Vec<Distinct> {
        let mut found = Vec::with_capacity(contacts.len());
        let mut from = 0;
        for to in 1..=contacts.len() {
            if to == contacts.len() || !self.are_one(&contacts[to - 1], &contacts[to], covariance, length) {
                found.push(told(contacts, from, to));
                from = to;
            }
        }
        found
    }

    /// The label of a state by these.
    pub fn label(&self, contacts: &[Contact], covariance: &DMatrix<f64>, length: f64) -> Label {
        let distinct = self.distinct(contacts, covariance, length);
        Label::of(distinct.len(), distinct.last().is_some_and(|last| last.contact.kind == ContactKind::Tip))
    }

    /// Whether two contacts may be one, as the hollow between them is shallow and perhaps not there.
    fn are_one(&self, one: &Contact, other: &Contact, covariance: &DMatrix<f64>, length: f64) -> bool {
        let may_be_none = |(depth, rates): &Dependent| {
            let pairs = rates.iter().flat_map(|(i, a)| rates.iter().map(move |(j, b)| a * b * covariance[(*i, *j)]));
            *depth < SHALLOW * length && *depth < KNOWN * pairs.sum::<f64>().max(0.0).sqrt()
        };
        self.hollow(one, other).is_some_and(|places| places.iter().all(may_be_none))
    }
}

/// The contact that some consecutive ones are told as.
fn told(contacts: &[Contact], from: usize, to: usize) -> Distinct {
    let own = &contacts[from..to];
    let force: f64 = own.iter().map(|contact| contact.force).sum();
    let heaviest = (0..own.len()).max_by(|i, j| own[*i].force.total_cmp(&own[*j].force)).unwrap_or(0);
    let heavy = own[heaviest];
    let mean = |of: fn(&Contact) -> f64| match force > 0.0 {
        true => own.iter().map(|contact| contact.force * of(contact)).sum::<f64>() / force,
        false => of(&heavy),
    };
    let mut contact = Contact { force, ..heavy };
    if heavy.kind != ContactKind::Tip {
        (contact.s, contact.x, contact.y) = (mean(|one| one.s), mean(|one| one.x), mean(|one| one.y));
    }
    let at = Vector2::new(contact.x, contact.y);
    let off = |one: &Contact| {
        let off = Vector2::new(one.x, one.y) - at;
        off * off.transpose() * (one.force / force.max(f64::MIN_POSITIVE))
    };
    Distinct { like: from + heaviest, contact, spread: own.iter().map(off).sum() }
}

#[cfg(test)]
mod tests {
    use super::super::curve::Node;
    use super::*;

    #[test]
    fn contacts_on_either_side_of_a_hollow_are_one_where_the_hollow_may_not_be_there() {
        // a hollow that is 20 um deep and 10 mm wide; the solid is above
        let places = [(0.0, 0.01), (0.01, 0.0), (0.015, 2e-5), (0.02, 0.0), (0.03, 0.01)];
        let chain: Vec<Node> = places.iter().map(|(x, y)| Node::smooth(Vector2::new(*x, *y), 1e-3)).collect();
        let curve = Curve::through(&[chain]).unwrap();
        let at = |x: f64, kind, force| {
            let (s, object, piece, y, alpha, friction) = (x + 0.05, 0, 0, 0.0, 0.0, None);
            Contact { object, piece, kind, s, x, y, alpha, force, friction }
        };
        let contacts = [at(0.01, ContactKind::Tangent, 0.1), at(0.02, ContactKind::Tangent, 0.3)];
        let known_to = |sigma: f64| DMatrix::identity(5, 5) * (sigma * sigma);

        let two = curve.distinct(&contacts, &known_to(1e-6), 0.1);
        assert_eq!(two.iter().map(|one| one.contact).collect::<Vec<_>>(), contacts);
        assert!(two.iter().all(|one| one.spread == Matrix2::zeros()));

        let [one] = &curve.distinct(&contacts, &known_to(1e-5), 0.1)[..] else { panic!("they may be one") };
        // where the resultant acts
        assert!((one.contact.x - 0.0175).abs() < 1e-15 && (one.contact.force - 0.4).abs() < 1e-15);
        assert!((one.spread[(0, 0)].sqrt() - 0.01 * (0.25_f64 * 0.75).sqrt()).abs() < 1e-15);
        assert_eq!(curve.label(&contacts, &known_to(1e-5), 0.1), Label::B);

        let at_tip = [at(0.01, ContactKind::Tangent, 0.1), at(0.02, ContactKind::Tip, 0.3)];
        assert_eq!(curve.label(&at_tip, &known_to(1e-5), 0.1), Label::A);
        assert_eq!(curve.label(&at_tip, &known_to(1e-6), 0.1), Label::BA);
    }
}
