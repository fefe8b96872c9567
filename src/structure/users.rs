//! Which of some lists hold a number.

/// Which of `lists`, ascending, hold each of the numbers below `count`: number k is in those of `users[starts[k]..starts[k + 1]]`.
pub(super) fn users<'a>(
    count: usize,
    lists: impl Iterator<Item = &'a [usize]> + Clone,
) -> (Vec<usize>, Vec<usize>) {
    let mut starts = vec![0; count + 1];
    lists.clone().flatten().for_each(|k| starts[k + 1] += 1);
    (0..count).for_each(|k| starts[k + 1] += starts[k]);
    let (mut next, mut users) = (starts.clone(), vec![0; starts[count]]);
    for (list, numbers) in lists.enumerate() {
        for k in numbers {
            users[next[*k]] = list;
            next[*k] += 1;
        }
    }
    (starts, users)
}
