//! A level that is being edited.

use crate::document::{merged, written};
use crate::history::History;
use crate::items::is_possible;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{GameText, HandText};
use std::sync::Arc;
use tamaire_play::level::LevelError;
use tamaire_play::{Level, Wish};

pub use crate::items::{Guide, aligned, snapped};

/// Maximum length of the name of a level [characters].
pub const MAX_NAME: usize = 60;

/// Maximum number of goals of a level.
pub const MAX_GOALS: usize = 8;

/// Largest gravity on each axis [m/s²].
const MAX_GRAVITY: f32 = 40.0;

/// Smallest and largest radius of a hand [m].
const HAND_RADII: [f32; 2] = [0.03, 0.3];

/// Name of a new level as long as it has no other one.
const NEW: &str = "new-level";

/// Text of a new level in 2D.
const BLANK: &str = include_str!("draft/blank.toml");

/// Text of a new level in 3D.
const BLANK_3D: &str = include_str!("draft/blank-3d.toml");

/// Language of a name.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Language {
    /// English, which every level has.
    English,
    /// Japanese.
    Japanese,
}

/// A level that is being edited, with the text from which it was read.
#[derive(Clone, Debug)]
pub struct Draft {
    id: String,
    /// Text of the level, and the scene that was read from it, without embedded files.
    source: Option<(String, Scene)>,
    start: Arc<Scene>,
    history: History<Arc<Scene>>,
    /// Scene while something is dragged.
    preview: Option<Arc<Scene>>,
}

impl Draft {
    /// Begins to edit a level. `text` is the text from which it was read, if it is known; its comments are kept.
    pub fn of_level(level: &Level, text: Option<&str>) -> Self {
        let mut scene = level.scene().clone();
        if let Some(game) = &mut scene.game {
            game.assists.clear();
        }
        let read =
            text.and_then(|text| Some((text.to_owned(), Scene::read(&level.id, text, &[]).ok()?)));
        Self::new(&level.id, scene, read)
    }

    /// Begins a new level in `dim` dimensions, 2 or 3: a closed room with a soft ball and a hand, without a basket.
    pub fn blank(dim: u8) -> Self {
        let text = if dim == 3 { BLANK_3D } else { BLANK };
        let scene = Scene::read(NEW, text, &[]).expect("tests read the texts of new levels");
        Self::new(NEW, scene.clone(), Some((text.to_owned(), scene)))
    }

    fn new(id: &str, scene: Scene, source: Option<(String, Scene)>) -> Self {
        let scene = Arc::new(scene);
        Self {
            id: id.to_owned(),
            source,
            start: scene.clone(),
            history: History::new(scene),
            preview: None,
        }
    }

    /// Returns the name of the level in [`Level::id`].
    pub fn id(&self) -> &str {
        &self.id
    }

    /// Sets the name of the level in [`Level::id`], for example to a file name. It is no step of undo.
    pub fn set_id(&mut self, id: &str) {
        self.id = id.to_owned();
    }

    /// Returns the scene as it is shown: with what is being dragged.
    pub fn scene(&self) -> &Scene {
        self.preview.as_deref().unwrap_or(self.history.present())
    }

    /// Makes a change, which is one step of undo. A preview is settled before.
    pub fn change<T>(&mut self, change: impl FnOnce(&mut Scene) -> T) -> T {
        self.settle();
        let mut scene = Scene::clone(self.history.present());
        let result = change(&mut scene);
        self.history.commit(Arc::new(scene));
        result
    }

    /// Shows a change of the scene as it was before the preview, in place of an earlier preview. It is no step of undo
    /// before [`Draft::settle`].
    pub fn preview<T>(&mut self, change: impl FnOnce(&mut Scene) -> T) -> T {
        let mut scene = Scene::clone(self.history.present());
        let result = change(&mut scene);
        self.preview = Some(Arc::new(scene));
        result
    }

    /// Makes the preview a step of undo. Returns whether there was one.
    pub fn settle(&mut self) -> bool {
        let Some(scene) = self.preview.take() else {
            return false;
        };
        self.history.commit(scene);
        true
    }

    /// Returns the scene without what is being dragged.
    pub fn scene_before(&self) -> &Scene {
        self.history.present()
    }

    /// Forgets the preview.
    pub fn cancel(&mut self) {
        self.preview = None;
    }

    /// Whether there is a step to undo, or a preview.
    pub fn can_undo(&self) -> bool {
        self.preview.is_some() || self.history.can_undo()
    }

    /// Whether there is an undone step.
    pub fn can_redo(&self) -> bool {
        self.preview.is_none() && self.history.can_redo()
    }

    /// Forgets the preview, or goes back one step. Returns whether there was either.
    pub fn undo(&mut self) -> bool {
        self.preview.take().is_some() || self.history.undo()
    }

    /// Makes the step again that was undone last. Returns whether there is one. A preview is forgotten.
    pub fn redo(&mut self) -> bool {
        self.preview = None;
        self.history.redo()
    }

    /// Whether the scene differs from that with which the draft began.
    pub fn is_changed(&self) -> bool {
        *self.scene() != *self.start
    }

    /// Returns the level.
    ///
    /// # Errors
    /// [`LevelError`] if the level cannot be played yet.
    pub fn level(&self) -> Result<Level, LevelError> {
        Level::from_scene(&self.id, self.scene().clone())
    }

    /// Returns the text of the level. It keeps the comments of the text from which it was read. Empty only if the scene has
    /// numbers that have no form in TOML.
    pub fn text(&self) -> String {
        let text = match &self.source {
            Some((text, before)) => merged(text, before, self.scene()),
            None => written(self.scene()),
        };
        text.unwrap_or_default()
    }

    /// Returns the name in a language; empty without one.
    pub fn name(&self, language: Language) -> &str {
        let name = self.scene().game.as_ref().map(|game| &game.name);
        match language {
            Language::English => name.map_or("", |name| &name.en),
            Language::Japanese => name.and_then(|name| name.ja.as_deref()).unwrap_or_default(),
        }
    }

    /// Returns the name in a language with which the draft began; empty without one.
    pub fn first_name(&self, language: Language) -> &str {
        let name = self.start.game.as_ref().map(|game| &game.name);
        match language {
            Language::English => name.map_or("", |name| &name.en),
            Language::Japanese => name.and_then(|name| name.ja.as_deref()).unwrap_or_default(),
        }
    }

    /// Sets the name of the maker. `None` removes it.
    pub fn set_maker(&mut self, name: Option<String>) {
        self.change_game(|game| game.made_by = name);
    }

    /// Notes from which level this one was made.
    pub fn set_origin(&mut self, name: &str) {
        self.change_game(|game| game.changed_from = Some(name.to_owned()));
    }

    /// Changes the rules of the level, if the scene has any.
    fn change_game(&mut self, change: impl FnOnce(&mut GameText)) {
        self.change(|scene| scene.game.as_mut().map(change));
    }

    /// Sets the name in a language. Control characters and spaces around it are removed, and it is cut to
    /// [`MAX_NAME`] characters. An empty Japanese name is removed; an empty English one changes nothing.
    pub fn set_name(&mut self, language: Language, name: &str) {
        let shown: String = name.chars().filter(|letter| !letter.is_control()).collect();
        let cut: String = shown.trim().chars().take(MAX_NAME).collect();
        let name = cut.trim_end().to_owned();
        self.change_game(|game| match language {
            Language::English if name.is_empty() => {}
            Language::English => game.name.en = name,
            Language::Japanese => game.name.ja = Some(name).filter(|name| !name.is_empty()),
        });
    }

    /// Sets the goals. Those that the level cannot have are left out, and all after the first [`MAX_GOALS`].
    pub fn set_goals(&mut self, goals: Vec<Wish>) {
        self.change(|scene| {
            let mut goals = goals;
            goals.retain(|goal| is_possible(scene, goal));
            goals.truncate(MAX_GOALS);
            if let Some(game) = &mut scene.game {
                game.wish = goals;
            }
        });
    }

    /// Sets the share of the mass that must rest in the basket, 0.01 to 1.
    pub fn set_share(&mut self, share: f32) {
        self.change_game(|game| set_within(&mut game.share, share, 0.01, 1.0));
    }

    /// Sets the time for which the mass must rest in the basket [s], 0 to 60; at least 0.1 if no hand may touch it there.
    pub fn set_hold(&mut self, hold: f32) {
        self.change_game(|game| {
            let least = if game.alone { 0.1 } else { 0.0 };
            set_within(&mut game.hold, hold, least, 60.0);
        });
    }

    /// Sets whether the basket counts only while no hand touches a piece in it.
    pub fn set_alone(&mut self, alone: bool) {
        self.change_game(|game| {
            game.alone = alone;
            if alone && game.hold <= 0.0 {
                game.hold = 1.0;
            }
        });
    }

    /// Sets gravity [m/s²], up to 40 on each axis. The third coordinate is ignored in 2D.
    pub fn set_gravity(&mut self, gravity: [f32; 3]) {
        self.change(|scene| {
            for axis in 0..usize::from(scene.dim.clamp(2, 3)) {
                set_within(
                    &mut scene.gravity[axis],
                    gravity[axis],
                    -MAX_GRAVITY,
                    MAX_GRAVITY,
                );
            }
        });
    }

    /// Sets the drag of the air [1/s], 0 to 10.
    pub fn set_drag(&mut self, drag: f32) {
        self.change(|scene| set_within(&mut scene.drag, drag, 0.0, 10.0));
    }

    /// Sets the radius of the hands of players that are balls [m], 0.03 to 0.3, and at most 0.44 of the width of the view.
    pub fn set_hand_size(&mut self, radius: f32) {
        self.change(|scene| {
            let [low, high] = scene.view;
            let axes = 0..usize::from(scene.dim.clamp(2, 3));
            let room = axes
                .map(|axis| high[axis] - low[axis])
                .fold(f32::INFINITY, f32::min);
            let [least, most] = HAND_RADII;
            let most = most.min(0.44 * room).max(least);
            let leads = |hand: &&mut HandText| hand.follows.is_none();
            for hand in scene.hand.iter_mut().filter(leads) {
                if let Some(own) = &mut hand.radius {
                    set_within(own, radius, least, most);
                }
            }
        });
    }
}

/// Sets a number to a value within a range. Leaves it if the value is not a number.
fn set_within(number: &mut f32, value: f32, low: f32, high: f32) {
    if !value.is_nan() {
        *number = value.clamp(low, high);
    }
}

#[cfg(test)]
mod tests;
