//! Names of similar spelling, for "did you mean".

use smol_str::SmolStr;

/// Most suggestions that are worth showing.
const MOST_SUGGESTIONS: usize = 3;

/// The candidates nearest to `name` in edit distance, best first, at most three; ties in alphabetical order.
pub fn similar_names<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Vec<SmolStr> {
    let allowed = name.chars().count().div_ceil(3).min(2);
    let mut near: Vec<(usize, &str)> = candidates
        .filter(|candidate| *candidate != name)
        .filter_map(|candidate| {
            distance_within(name, candidate, allowed).map(|distance| (distance, candidate))
        })
        .collect();
    near.sort_unstable();
    near.dedup();
    near.into_iter().take(MOST_SUGGESTIONS).map(|(_, candidate)| SmolStr::new(candidate)).collect()
}

/// The edit distance (with transpositions of neighbours), if it is at most `limit`.
fn distance_within(left: &str, right: &str, limit: usize) -> Option<usize> {
    let left: Vec<char> = left.chars().collect();
    let right: Vec<char> = right.chars().collect();
    if left.len().abs_diff(right.len()) > limit {
        return None;
    }
    let mut before = vec![0; right.len() + 1];
    let mut previous: Vec<usize> = (0..=right.len()).collect();
    for (row, a) in left.iter().enumerate() {
        let mut current = vec![row + 1; right.len() + 1];
        for (column, b) in right.iter().enumerate() {
            let swap =
                row > 0 && column > 0 && left.get(row - 1) == Some(b) && right.get(column - 1) == Some(a);
            let mut best = (previous[column] + usize::from(a != b)).min(previous[column + 1] + 1);
            best = best.min(current[column] + 1);
            if swap {
                best = best.min(before[column - 1] + 1);
            }
            current[column + 1] = best;
        }
        before = std::mem::replace(&mut previous, current);
    }
    previous.last().copied().filter(|distance| *distance <= limit)
}

#[cfg(test)]
mod tests {
    use super::similar_names;

    #[test]
    fn nearest_names_come_first() {
        let names = ["L1", "L2", "P1", "P12", "CIRC1"];
        assert_eq!(similar_names("P2", names.into_iter()), ["L2", "P1", "P12"]);
        assert_eq!(similar_names("CICR1", names.into_iter()), ["CIRC1"]);
        assert!(similar_names("ZZZZ", names.into_iter()).is_empty());
    }
}
