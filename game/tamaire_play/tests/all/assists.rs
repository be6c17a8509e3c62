//! Test of the assists: with all of them, a bot wins every level by pushing the whole body into the basket.

use std::collections::BTreeSet;
use std::sync::Arc;
use tamaire_play::level::{NAMED, NAMED_3D};
use tamaire_play::{AnyRound, Assist, Bot, BotKind, Level, Outcome, Route};

/// Time limit of a round: a minute [ticks].
const MINUTE: usize = 60 * 60;

/// Lets a bot push the body into the basket of a level with `assists`. Returns the outcome if the bot wins.
fn squeezed(level: &Level, assists: &[Assist], seed: u64) -> Option<Outcome> {
    let easy = level.assisted(&BTreeSet::from_iter(assists.iter().copied()));
    let mut round = AnyRound::new(Arc::new(easy.unwrap()));
    round.play(&mut Bot::new(BotKind::Squeeze, seed), MINUTE)
}

#[test]
fn squeezing_wins_every_level_with_all_assists() {
    for (id, _) in NAMED.iter().chain(&NAMED_3D) {
        let level = Level::open(id).unwrap();
        if !level.has_basket() {
            continue;
        }
        let outcome = squeezed(&level, &[Assist::WiderBasket, Assist::Unbreakable], 301);
        let outcome = outcome.unwrap_or_else(|| panic!("{id} is not won"));
        let torn = (outcome.route, outcome.lost);
        assert_eq!(torn, (Route::Squeeze, 0), "{id}: {outcome:?}");
    }
}

#[test]
fn wider_basket_is_won_sooner() {
    let twins = Level::open("twins").unwrap();
    let ticks = |assists: &[Assist]| -> u64 {
        let won = (301..306).map(|seed| squeezed(&twins, assists, seed));
        won.map(|outcome| outcome.map_or(MINUTE as u64, |outcome| outcome.ticks))
            .sum()
    };
    let [plain, wide] = [ticks(&[]), ticks(&[Assist::WiderBasket])];
    assert!(wide < plain, "{wide} ticks, without assist {plain}");
}
