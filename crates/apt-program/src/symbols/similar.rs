//! Names of similar spelling, for "did you mean".

use smol_str::SmolStr;

/// Most suggestions that are worth showing.
const MOST_SUGGESTIONS: usize = 3;

/// The candidates nearest to `name` in edit distance, best first, at most three; ties in alphabetical order. Names without
/// any letter in common are not alike, however short they are.
pub fn similar_names<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Vec<SmolStr> {
    let letters: Vec<char> = name.chars().collect();
    let mut allowed = letters.len().div_ceil(3).min(2);
    let mut near: Vec<(usize, &str)> = Vec::with_capacity(MOST_SUGGESTIONS + 1);
    let mut candidate_letters = Vec::new();
    for candidate in candidates {
        candidate_letters.clear();
        candidate_letters.extend(candidate.chars());
        let Some(distance) = distance_within(&letters, &candidate_letters, allowed) else { continue };
        let found = (distance, candidate);
        let longest = letters.len().max(candidate_letters.len());
        if distance == 0 || distance >= longest || near.contains(&found) {
            continue;
        }
        near.insert(near.partition_point(|other| *other < found), found);
        near.truncate(MOST_SUGGESTIONS);
        if let [.., (farthest, _)] = near[..]
            && near.len() == MOST_SUGGESTIONS
        {
            // What is farther away is not told: of many names most are seen to be so at once.
            allowed = farthest;
        }
    }
    near.into_iter().map(|(_, candidate)| SmolStr::new(candidate)).collect()
}

/// The edit distance (with transpositions of neighbours), if it is at most `limit`.
fn distance_within(left: &[char], right: &[char], limit: usize) -> Option<usize> {
    if left.len().abs_diff(right.len()) > limit {
        return None;
    }
    let (left, right) = without_common_ends(left, right);
    match (left, right) {
        ([], rest) | (rest, []) => Some(rest.len()),
        ([_], [_]) => Some(1),
        ([a, b], [c, d]) if (a, b) == (d, c) => Some(1),
        // One change leaves no more than that between the common ends.
        _ if limit < 2 => None,
        _ => Some(distance(left, right)),
    }
    .filter(|distance| *distance <= limit)
}

/// What lies between the common beginning and the common end of two names.
fn without_common_ends<'n>(mut left: &'n [char], mut right: &'n [char]) -> (&'n [char], &'n [char]) {
    while let ([a, left_rest @ ..], [b, right_rest @ ..]) = (left, right)
        && a == b
    {
        (left, right) = (left_rest, right_rest);
    }
    while let ([left_rest @ .., a], [right_rest @ .., b]) = (left, right)
        && a == b
    {
        (left, right) = (left_rest, right_rest);
    }
    (left, right)
}

/// The edit distance, row by row.
fn distance(left: &[char], right: &[char]) -> usize {
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
    previous.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::{distance, similar_names};

    #[test]
    fn nearest_names_come_first() {
        let names = ["L1", "L2", "P1", "P12", "CIRC1"];
        assert_eq!(similar_names("P2", names.into_iter()), ["L2", "P1", "P12"]);
        assert_eq!(similar_names("CICR1", names.into_iter()), ["CIRC1"]);
        assert!(similar_names("ZZZZ", names.into_iter()).is_empty());
    }

    /// All words of these letters up to a length.
    fn words(letters: &str, longest: usize) -> Vec<String> {
        let mut words = vec![String::new()];
        let mut from = 0;
        for _ in 0..longest {
            let longer: Vec<String> = words[from..]
                .iter()
                .flat_map(|word| letters.chars().map(move |one| format!("{word}{one}")))
                .collect();
            from = words.len();
            words.extend(longer);
        }
        words
    }

    #[test]
    fn the_nearest_are_those_of_all_distances() {
        let names = words("P12", 5);
        let letters = |word: &str| word.chars().collect::<Vec<char>>();
        for name in names.iter().step_by(7) {
            let allowed = name.len().div_ceil(3).min(2);
            let mut all: Vec<(usize, &String)> = names
                .iter()
                .map(|other| (distance(&letters(name), &letters(other)), other))
                .filter(|(distance, other)| {
                    (1..=allowed).contains(distance) && *distance < name.len().max(other.len())
                })
                .collect();
            all.sort_unstable();
            let nearest: Vec<&str> = all.iter().take(3).map(|(_, other)| other.as_str()).collect();
            let twice = names.iter().chain(names.iter().rev()).map(String::as_str);
            assert_eq!(similar_names(name, twice), nearest, "{name}");
        }
    }
}
