//! Who sleeps: pieces that have been slow for a while, together with all they lean on.
//!
//! An *island* is what is joined by contacts. It falls asleep as a whole and wakes as a whole:
//! half a heap that slept on while the other half moved would hang in the air.

use crate::body::Body;
use crate::contact::Hit;
use crate::damping::PieceMotion;
use crate::dim::Dim;
use crate::touch::Nearby;
use std::collections::BTreeMap;

/// Pieces slower than this [m/s], on the average over their nodes, are on their way to sleep.
const SLOW: f64 = 0.03;
/// How long they must have been [s].
const STILL_TIME: f32 = 0.5;

/// The numbers of all pieces of all bodies in one row.
pub struct Numbering {
    first: Vec<usize>,
}

impl Numbering {
    /// The pieces that there are now.
    pub fn of<D: Dim>(bodies: &[Body<D>]) -> Self {
        let mut first = vec![0];
        for body in bodies {
            first.push(first[first.len() - 1] + body.pieces.list.len());
        }
        Self { first }
    }

    fn number(&self, body: u32, piece: u32) -> usize {
        self.first[body as usize] + piece as usize
    }

    fn count(&self) -> usize {
        self.first[self.first.len() - 1]
    }
}

/// Counts for how long each piece has been slow, and puts islands to sleep in which all have been
/// long enough. `touched` marks the pieces that a hand touches: they stay awake. Returns who fell asleep.
pub fn fall_asleep<D: Dim>(
    bodies: &mut [Body<D>],
    nearby: &Nearby,
    motions: &[Vec<PieceMotion>],
    touched: &[Hit],
    duration: f32,
) -> Vec<Hit> {
    for (body, motions) in bodies.iter_mut().zip(motions) {
        for (piece, motion) in body.pieces.list.iter_mut().zip(motions) {
            if piece.asleep {
                continue;
            }
            let slow = motion.speed_squared < SLOW * SLOW && !motion.is_driven;
            piece.still = if slow { piece.still + duration } else { 0.0 };
        }
    }
    for &(body, piece) in touched {
        bodies[body as usize].pieces.list[piece as usize].still = 0.0;
    }
    let numbering = Numbering::of(bodies);
    let island = islands(&numbering, nearby);
    let mut restless = vec![false; numbering.count()];
    for (place, body) in bodies.iter().enumerate() {
        for (piece, state) in body.pieces.list.iter().enumerate() {
            let number = numbering.number(place as u32, piece as u32);
            restless[island[number]] |= !state.asleep && state.still < STILL_TIME;
        }
    }
    let mut names = Names::of_sleepers(bodies, &numbering, &island);
    let mut fallen = Vec::new();
    for (place, body) in bodies.iter_mut().enumerate() {
        let mut marked = vec![false; body.pieces.list.len()];
        for (piece, state) in body.pieces.list.iter_mut().enumerate() {
            let root = island[numbering.number(place as u32, piece as u32)];
            if !state.asleep && !restless[root] {
                marked[piece] = true;
                state.island = names.of_island(root);
                fallen.push((place as u32, piece as u32));
            }
            state.island = names.now(state.island);
        }
        if marked.contains(&true) {
            body.set_asleep(&marked, true);
        }
    }
    fallen
}

/// What islands are called: who falls asleep on a sleeping island joins it.
struct Names {
    by_root: BTreeMap<usize, u32>,
    renamed: BTreeMap<u32, u32>,
    fresh: u32,
}

impl Names {
    fn of_sleepers<D: Dim>(bodies: &[Body<D>], numbering: &Numbering, island: &[usize]) -> Self {
        let mut names = Self {
            by_root: BTreeMap::new(),
            renamed: BTreeMap::new(),
            fresh: 0,
        };
        for (place, body) in bodies.iter().enumerate() {
            for (piece, state) in body.pieces.list.iter().enumerate() {
                names.fresh = names.fresh.max(state.island + 1);
                if !state.asleep {
                    continue;
                }
                let root = island[numbering.number(place as u32, piece as u32)];
                let name = names.now(state.island);
                let first = *names.by_root.entry(root).or_insert(name);
                if names.now(first) != name {
                    let first = names.now(first);
                    names.renamed.insert(name, first);
                }
            }
        }
        names
    }

    fn of_island(&mut self, root: usize) -> u32 {
        let fresh = self.fresh;
        let name = *self.by_root.entry(root).or_insert(fresh);
        self.fresh += u32::from(name == fresh);
        name
    }

    fn now(&self, mut name: u32) -> u32 {
        while let Some(&next) = self.renamed.get(&name) {
            name = next;
        }
        name
    }
}

/// Wakes the islands of the pieces that were hit; returns who woke.
pub fn wake<D: Dim>(bodies: &mut [Body<D>], hits: &[Hit]) -> Vec<Hit> {
    let mut islands = Vec::new();
    for &(body, piece) in hits {
        let state = &bodies[body as usize].pieces.list[piece as usize];
        if state.asleep && !state.quarantined {
            islands.push(state.island);
        }
    }
    let mut woken = Vec::new();
    if islands.is_empty() {
        return woken;
    }
    for (place, body) in bodies.iter_mut().enumerate() {
        let wakes = |piece: &crate::piece::Piece| {
            piece.asleep && !piece.quarantined && islands.contains(&piece.island)
        };
        let marked: Vec<bool> = body.pieces.list.iter().map(wakes).collect();
        let numbers = (0..marked.len() as u32).filter(|&piece| marked[piece as usize]);
        woken.extend(numbers.map(|piece| (place as u32, piece)));
        if marked.contains(&true) {
            body.set_asleep(&marked, false);
        }
    }
    woken
}

/// The lowest number in the island of each piece.
fn islands(numbering: &Numbering, nearby: &Nearby) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..numbering.count()).collect();
    fn root(parent: &mut [usize], mut at: usize) -> usize {
        while parent[at] != at {
            parent[at] = parent[parent[at]];
            at = parent[at];
        }
        at
    }
    for pair in &nearby.skin_pairs {
        if pair.impulse.pressed <= 0.0 {
            continue;
        }
        let [a, b] = pair.skins.map(|skin| {
            let skin = &nearby.skins[skin as usize];
            numbering.number(skin.body, skin.piece)
        });
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent[a.max(b)] = a.min(b);
    }
    (0..parent.len())
        .map(|number| root(&mut parent, number))
        .collect()
}
