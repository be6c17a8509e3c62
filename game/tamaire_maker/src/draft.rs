//! A level that is being edited.

use crate::document::{merged, written};
use crate::history::History;
use crate::items::items;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::GameText;
use std::sync::Arc;
use tamaire_play::Level;
use tamaire_play::level::LevelError;

/// Maximum length of the name of a level [characters].
pub const MAX_NAME: usize = 60;

/// Maximum size of the steps of undo [bytes].
const MAX_HISTORY: usize = 256 << 20;

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
            // A level file may not claim assists: only a recorded round does, for those that its player used.
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

    /// Changes the scene, and makes it the start of the history.
    pub fn restart(&mut self, change: impl FnOnce(&mut Scene)) {
        let mut scene = self.scene().clone();
        change(&mut scene);
        let scene = Arc::new(scene);
        self.start = scene.clone();
        self.history = History::new(scene);
        self.preview = None;
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

    /// Returns the scene with the preview.
    pub fn scene(&self) -> &Scene {
        self.preview.as_deref().unwrap_or(self.history.present())
    }

    /// Makes a change, which is one step of undo. A preview is settled before.
    pub fn change<T>(&mut self, change: impl FnOnce(&mut Scene) -> T) -> T {
        self.settle();
        let mut scene = Scene::clone(self.history.present());
        let result = change(&mut scene);
        self.commit(Arc::new(scene));
        result
    }

    fn commit(&mut self, scene: Arc<Scene>) {
        self.history.commit(scene);
        self.history
            .forget_beyond(MAX_HISTORY, |scene| size_of(scene));
    }

    /// Makes a change that is no step of undo. A preview is settled before.
    pub fn amend(&mut self, change: impl FnOnce(&mut Scene)) {
        self.settle();
        let mut scene = Scene::clone(self.history.present());
        change(&mut scene);
        if scene != **self.history.present() {
            self.history.amend(Arc::new(scene));
        }
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
        self.commit(scene);
        true
    }

    /// Forgets the preview.
    pub fn forget_preview(&mut self) {
        self.preview = None;
    }

    /// Returns the scene with the preview. Equal pointers mean equal scenes.
    pub fn shared_scene(&self) -> &Arc<Scene> {
        self.preview.as_ref().unwrap_or(self.history.present())
    }

    /// Returns the scene without the preview. Equal pointers mean equal scenes.
    pub fn shared_before(&self) -> &Arc<Scene> {
        self.history.present()
    }

    /// Returns the scene without the preview.
    pub fn scene_before(&self) -> &Scene {
        self.history.present()
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

    /// Returns the level.
    ///
    /// # Errors
    /// [`LevelError`] if the level cannot be played yet.
    pub fn level(&self) -> Result<Level, LevelError> {
        Level::from_scene(&self.id, self.scene().clone())
    }

    /// Returns the text of the level, with the comments of the text from which it was read. The result is empty if the scene
    /// has a value that TOML cannot express, for example `user_data` above `i64::MAX`.
    pub fn text(&self) -> String {
        let text = match &self.source {
            Some((text, before)) => merged(text, before, self.scene()),
            None => written(self.scene()),
        };
        text.unwrap_or_default()
    }

    /// Returns the name in a language; empty without one.
    pub fn name(&self, language: Language) -> &str {
        name_in(self.scene(), language)
    }

    /// Returns the name in a language with which the draft began; empty without one.
    pub fn first_name(&self, language: Language) -> &str {
        name_in(&self.start, language)
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

    /// Shows names as a preview, so that typing a name is one step of undo. Names in other languages stay as they were
    /// before the preview. Each name is set as by [`set_name`].
    pub fn set_names(&mut self, names: &[(Language, &str)]) {
        self.preview(|scene| {
            for &(language, name) in names {
                set_name(scene, language, name);
            }
        });
    }
}

/// Returns the name of a scene in a language; empty without one.
pub fn name_in(scene: &Scene, language: Language) -> &str {
    let name = scene.game.as_ref().map(|game| &game.name);
    match language {
        Language::English => name.map_or("", |name| &name.en),
        Language::Japanese => name.and_then(|name| name.ja.as_deref()).unwrap_or_default(),
    }
}

/// Sets the name of a level in a language. Control characters and spaces around it are removed, and it is cut to
/// [`MAX_NAME`] characters. An empty Japanese name is removed. A level with an empty English name cannot be played.
pub fn set_name(scene: &mut Scene, language: Language, name: &str) {
    let Some(game) = &mut scene.game else {
        return;
    };
    let shown: String = name.chars().filter(|letter| !letter.is_control()).collect();
    let cut: String = shown.trim().chars().take(MAX_NAME).collect();
    let name = cut.trim_end().to_owned();
    match language {
        Language::English => game.name.en = name,
        Language::Japanese => game.name.ja = Some(name).filter(|name| !name.is_empty()),
    }
}

/// Returns a name without the number at its end, and that number, if it has one below 100.
pub fn without_number(name: &str) -> (&str, Option<usize>) {
    let parts = name.rsplit_once(' ');
    let numbered = parts.and_then(|(stem, number)| Some((stem, number.parse::<usize>().ok()?)));
    match numbered.filter(|(stem, number)| !stem.is_empty() && *number < 100) {
        Some((stem, number)) => (stem, Some(number)),
        None => (name, None),
    }
}

/// Returns whether a name is that of a new level, with or without a number.
pub fn is_usual_name(name: &str, language: Language) -> bool {
    without_number(name).0 == Draft::blank(2).name(language)
}

/// Returns about how much memory a scene takes [bytes].
fn size_of(scene: &Scene) -> usize {
    /// Size of an entry of a list without its texts [bytes].
    const ENTRY: usize = 512;
    let texts = scene.body.iter().map(|body| {
        let content = body.content.as_ref().map_or(0, String::len);
        let state = body.state.as_ref().map_or(0, String::len);
        content + state + body.voxels.as_ref().map_or(0, |voxels| voxels.runs.len())
    });
    let entries = items(scene).len() + scene.material.len();
    texts.sum::<usize>() + ENTRY * (entries + 1)
}

#[cfg(test)]
mod tests;
