//! Counters that wrap and begin anew.

use proptest::prelude::*;
use rod_hw::*;

#[test]
fn restart_and_its_look_alike() {
    let mut sequence = Sequence::new(32);
    let steps = [1000, 1001, 1, 2, 3].map(|n| sequence.step(n));
    assert_eq!(
        steps,
        [SequenceStep::First, SequenceStep::Next, SequenceStep::Late, SequenceStep::Restarted, SequenceStep::Next]
    );
    let mut sequence = Sequence::new(16);
    let steps = [65_535, 0, 2, 1, 3].map(|n| sequence.step(n));
    assert_eq!(
        steps,
        [SequenceStep::First, SequenceStep::Next, SequenceStep::Gap(1), SequenceStep::Late, SequenceStep::Next]
    );
    assert_eq!(sequence.unwrapped(), 65_536 + 3);
}

proptest! {
    #[test]
    fn missing_numbers_add_up(start: u32, gaps in proptest::collection::vec(1_u32..1000, 1..100)) {
        let mut sequence = Sequence::new(32);
        sequence.step(start);
        let (mut number, mut missing) = (start, 0);
        for gap in &gaps {
            number = number.wrapping_add(*gap);
            if let SequenceStep::Gap(n) = sequence.step(number) { missing += n }
        }
        prop_assert_eq!(missing, gaps.iter().map(|gap| gap - 1).sum::<u32>());
        prop_assert_eq!(sequence.unwrapped(), u64::from(start) + gaps.iter().map(|gap| u64::from(*gap)).sum::<u64>());
    }
}
