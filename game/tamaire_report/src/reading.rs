//! What the authors saw in 2004, asked of the figures [Endo 2004, §4.3]: two strategies appeared, nobody needed an
//! explanation, and who had won one way tried the other.

use crate::figures::Figures;
use crate::spread::interval;
use tamaire_play::Route;

/// With fewer than this nothing is said of shares.
const FEW: u64 = 20;
/// A route that fewer of the wins went did not appear.
const RARE: f64 = 0.05;

/// Which strategies appeared.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Strategies {
    /// There are too few wins to tell.
    Few,
    /// Both.
    Both,
    /// Hardly any but this one.
    Only(Route),
}

/// Whether people won without an explanation from the game.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Unexplained {
    /// There are too few visits to tell.
    Few,
    /// More than half of all visits won, surely.
    Most,
    /// About half did.
    Half,
    /// Less than half did, surely.
    Minority,
}

/// Whether there are enough visits that won twice to speak of the other way.
pub fn tells_switching(figures: &Figures) -> bool {
    won_again(figures) >= FEW
}

/// Visits that won more than once.
pub fn won_again(figures: &Figures) -> u64 {
    let after = figures.switching.after.iter();
    after.map(|after| after.won()).sum()
}

/// Which strategies appeared.
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

/// Whether people won without an explanation from the game.
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
