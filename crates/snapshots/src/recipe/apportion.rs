//! Apportionment of an integer in proportion to weights.

/// Divides a number in proportion to weights (Hamilton's method). Each weight gets its quota, rounded down, and the
/// rest goes to the largest remainders. If remainders are equal, the earlier weight comes first. If all weights are
/// 0, all results are 0.
pub(crate) fn apportion(number: u32, weights: &[f64]) -> Vec<u32> {
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return vec![0; weights.len()];
    }
    let exact: Vec<f64> = weights.iter().map(|weight| f64::from(number) * weight / total).collect();
    let mut shares: Vec<u32> = exact.iter().map(|share| share.floor() as u32).collect();
    let mut order: Vec<usize> = (0..weights.len()).collect();
    let remainder = |at: usize| exact[at] - exact[at].floor();
    order.sort_by(|&a, &b| remainder(b).total_cmp(&remainder(a)));
    let left = number.saturating_sub(shares.iter().sum());
    for &at in order.iter().cycle().take(left as usize) {
        shares[at] += 1;
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up() {
        for (number, weights, expect) in [
            (10, &[1.0, 1.0, 1.0][..], &[4, 3, 3][..]),
            (7, &[0.5, 0.3, 0.2], &[4, 2, 1]),
            (0, &[1.0], &[0]),
            (5, &[0.0, 2.0], &[0, 5]),
            (3, &[0.0, 0.0], &[0, 0]),
        ] {
            assert_eq!(apportion(number, weights), expect);
        }
    }
}
