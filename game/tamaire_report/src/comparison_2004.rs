//! Comparison with the observations of 2004 [Endo 2004, §4.3]: two strategies appeared, visitors needed no
//! explanation, and visitors who had won by one strategy tried the other.

use crate::figures::Figures;
use crate::spread::interval;
use tamaire_play::Route;

/// Minimum number of wins or visits for a statement about shares.
const FEW: u64 = 20;
/// Minimum share of the wins for a route to count as a strategy that appeared.
const RARE: f64 = 0.05;

/// Strategies that appeared.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Strategies {
    /// Too few wins to tell.
    Few,
    /// Both strategies.
    Both,
    /// Only this route reached the minimum share; [`Route::Mix`] if neither strategy reached it.
    Only(Route),
}

/// Evidence on whether visitors win without an explanation.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Unexplained {
    /// Too few visits to tell.
    Few,
    /// More than half of all visits won: the 95 % confidence interval of their share lies above one half.
    Most,
    /// The 95 % confidence interval of the share of visits that won contains one half.
    Half,
    /// Less than half of all visits won: the 95 % confidence interval of their share lies below one half.
    Minority,
}

/// Returns whether enough visits won twice for a statement about switching.
pub fn tells_switching(figures: &Figures) -> bool {
    won_again(figures) >= FEW
}

/// Returns the number of visits that won more than once.
pub fn won_again(figures: &Figures) -> u64 {
    let after = figures.switching.after.iter();
    after.map(|after| after.won()).sum()
}

/// Returns the strategies that appeared.
pub fn strategies(figures: &Figures) -> Strategies {
    let wins = figures.total.rounds;
    let least = (RARE * wins.won() as f64).max(3.0);
    let appeared = |count: u64| count as f64 >= least;
    match (appeared(wins.squeeze), appeared(wins.shave)) {
        _ if wins.won() < FEW => Strategies::Few,
        (true, true) => Strategies::Both,
        (true, false) => Strategies::Only(Route::Squeeze),
        (false, true) => Strategies::Only(Route::Shave),
        (false, false) => Strategies::Only(Route::Mix),
    }
}

/// Returns the evidence on whether visitors win without an explanation.
pub fn unexplained(figures: &Figures) -> Unexplained {
    let total = &figures.total;
    let [low, high] = interval(total.visits_won, total.visits);
    match () {
        () if total.visits < FEW => Unexplained::Few,
        () if low > 0.5 => Unexplained::Most,
        () if high < 0.5 => Unexplained::Minority,
        () => Unexplained::Half,
    }
}
