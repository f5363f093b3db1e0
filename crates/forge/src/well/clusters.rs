//! Clusters of similar games, and the probability mass of unseen clusters.

use super::species::good_turing;

/// Leader clusters. Each game joins the first cluster whose leader is within a given distance. If there is none, the
/// game becomes the leader of a new cluster.
#[derive(Debug)]
pub(super) struct Clusters {
    within: f64,
    leaders: Vec<usize>,
    sizes: Vec<u64>,
}

impl Clusters {
    pub(super) fn within(within: f64) -> Clusters {
        Clusters { within, leaders: Vec::new(), sizes: Vec::new() }
    }

    /// Adds the next game, given its distances to all earlier games in the order in which they were added.
    pub(super) fn add(&mut self, distances: &[f64]) {
        match self.leaders.iter().position(|leader| distances[*leader] < self.within) {
            Some(cluster) => self.sizes[cluster] += 1,
            None => {
                self.leaders.push(distances.len());
                self.sizes.push(1);
            }
        }
    }

    /// Returns the Good–Turing estimate of the probability that the next game belongs to no known cluster; `None`
    /// without games.
    pub(super) fn unseen(&self) -> Option<f64> {
        good_turing(self.sizes.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn games_join_the_first_leader_that_is_near() {
        let mut clusters = Clusters::within(0.3);
        // Four points on a line: 0, 0.2, 0.4, 0.9.
        clusters.add(&[]);
        clusters.add(&[0.2]);
        clusters.add(&[0.4, 0.2]);
        clusters.add(&[0.9, 0.7, 0.5]);
        assert_eq!((&clusters.leaders, &clusters.sizes), (&vec![0, 2, 3], &vec![2, 1, 1]));
        assert_eq!(clusters.unseen(), Some(0.5));
        assert_eq!(Clusters::within(0.3).unseen(), None);
    }
}
