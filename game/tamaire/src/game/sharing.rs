//! Checking, keeping and sending of levels that the player makes.

use super::{Game, Maker, Screen};
use crate::platform::{MOST_LEVELS, address_of_page};
use crate::qr::Code;
use crate::words::MakingWords;
use fuwafuwa_scenes::Scene;
use std::sync::Arc;
use tamaire_maker::check::Check;
use tamaire_maker::draft::{Draft, Language};
use tamaire_play::level::{LevelError, MAX_KEPT_BYTES};
use tamaire_play::pack::without_marks;
use tamaire_play::{Level, Replay};

/// Maximum length of the name of a level or of its maker [characters].
pub const MOST_NAME: usize = 40;
/// Beginning of the ids of levels that the player makes. Levels from elsewhere get other ids.
const MADE_HERE: &str = "my-level-";
/// Share of a frame in which checks are computed, and the least and most time for that [s]. On a machine that draws slowly,
/// frames are long, and the checks get on nevertheless.
const BUDGET: (f64, [f64; 2]) = (0.6, [0.008, 0.15]);

/// Whether a level with this id was made by the player of this game.
pub(super) fn is_made_here(id: &str) -> bool {
    id.starts_with(MADE_HERE)
}

/// Returns the id of a level from elsewhere.
pub(super) fn foreign_id(id: &str) -> String {
    match id.strip_prefix(MADE_HERE) {
        Some(rest) => format!("sent-level-{rest}"),
        None => id.to_string(),
    }
}

/// What the page *Finish* shows of a level, computed once for each scene.
pub struct Summary {
    scene: Arc<Scene>,
    /// The level, or why it cannot be played.
    pub level: Result<Arc<Level>, LevelError>,
    /// Shortest time in which its maker has won it [s].
    pub won: Option<f32>,
    /// QR code of the link to it, once it was asked for. The inner `None` = the level is too large for one.
    code: Option<Option<Code>>,
}

impl Maker {
    /// Returns the summary of the level as it is now.
    pub fn summary(&mut self) -> &mut Summary {
        let scene = self.draft.shared_scene();
        let is_known = |known: &Summary| Arc::ptr_eq(&known.scene, scene);
        if !self.summary.as_ref().is_some_and(is_known) {
            let level = self.draft.level().map(Arc::new);
            let won = level.as_ref().ok().and_then(|level| self.win_of(level));
            let won = won.and_then(|won| won.outcome);
            self.summary = Some(Summary {
                scene: scene.clone(),
                won: won.map(|outcome| outcome.seconds()),
                level,
                code: None,
            });
        }
        self.summary.as_mut().expect("the summary was just made")
    }

    /// Returns the win of the level as it is now by its maker, even if the level has another name since.
    fn win_of(&self, level: &Level) -> Option<Replay> {
        self.won.as_ref()?.renamed(level)
    }

    /// Returns the scene with the names of its maker and of its origin.
    fn credited(&self, maker: &str) -> Scene {
        let mut scene = self.draft.scene().clone();
        let maker = cleaned(maker);
        if let Some(game) = &mut scene.game {
            game.made_by = (!maker.is_empty()).then_some(maker);
            if let Some(origin) = &self.origin {
                game.changed_from = Some(origin.clone());
            }
        }
        scene
    }
}

impl Game {
    /// Returns the name of the level that is being edited, in the language of the player if it has one.
    pub fn draft_name(&self) -> &str {
        let names =
            [self.language_of_names(), Language::English].map(|it| self.maker.draft.name(it));
        names
            .into_iter()
            .find(|name| !name.is_empty())
            .unwrap_or_default()
    }

    /// Names the level that is being edited, in the language of the player. In the other language it gets the same name,
    /// unless the player has given it another one there.
    pub fn name_draft(&mut self, name: &str) {
        let language = self.language_of_names();
        let other = match language {
            Language::English => Language::Japanese,
            Language::Japanese => Language::English,
        };
        let draft = &mut self.maker.draft;
        let follows = draft.name(other).is_empty()
            || draft.name(other) == draft.name(language)
            || draft.name(other) == draft.first_name(other);
        draft.set_name(language, name);
        if follows {
            // Without a Japanese name, the English one is shown.
            draft.set_name(other, if other == Language::English { name } else { "" });
        }
    }

    fn language_of_names(&self) -> Language {
        match self.settings.language {
            crate::words::Language::English => Language::English,
            crate::words::Language::Japanese => Language::Japanese,
        }
    }

    /// Notes that the maker has won the level, if the round is a test of it.
    pub(super) fn note_test_win(&mut self) {
        let level = self.bout.round().level().clone();
        let tested = self.maker.summary().level.as_ref().ok();
        let is_tested = tested.is_some_and(|tested| tested.differs_only_in_names(&level));
        if !self.is_test() || !is_tested {
            return;
        }
        let replay = self.bout.round().replay();
        let known = self.maker.win_of(&level);
        if known.is_none_or(|known| replay.clock_ticks() < known.clock_ticks()) {
            self.maker.won = Some(replay);
            self.maker.summary = None;
        }
    }

    /// Begins to check the level that is being edited, or goes on with it in a frame of `seconds` [s].
    pub fn check_draft(&mut self, seconds: f32) {
        let Ok(level) = self.maker.summary().level.as_ref().map(Arc::clone) else {
            self.maker.check = None;
            return;
        };
        let is_known = { self.maker.check.as_ref() }.is_some_and(|check| {
            Arc::ptr_eq(check.level(), &level) || check.level().differs_only_in_names(&level)
        });
        if !is_known {
            self.maker.check = Some(Check::new(level));
        }
        let clock = self.clock.clone();
        if let Some(check) = &mut self.maker.check {
            let (share, [least, most]) = BUDGET;
            let budget = (share * f64::from(seconds)).clamp(least, most);
            check.go_on(budget, || clock.now());
        }
    }

    /// Returns why the level that is being edited is not finished, in words for its maker. `None` if it can be kept.
    pub fn draft_problem(&mut self) -> Option<String> {
        if self.maker.draft.name(Language::English).trim().is_empty() {
            return Some(self.making().needs_name.to_string());
        }
        let level = &self.maker.summary().level;
        let is_outside = matches!(level, Err(LevelError::NoGame { field: "body", .. }));
        let told = self.words().level_error;
        match &self.maker.summary().level {
            Ok(_) => None,
            Err(_) if is_outside => Some(self.making().body_outside.to_string()),
            Err(error) => Some(told(error)),
        }
    }

    /// Returns the level that is being edited with the names of its maker and of its origin, ready to be kept.
    fn finished(&mut self) -> Option<Level> {
        self.maker.draft.settle();
        if let Some(problem) = self.draft_problem() {
            self.notify(problem);
            return None;
        }
        let credited = self.maker.credited(&self.settings.maker_name);
        self.maker.draft.change(|scene| *scene = credited);
        self.maker.draft.level().ok()
    }

    /// Keeps the level beside the shipped ones. Returns whether it can be kept.
    pub fn keep_draft(&mut self) -> bool {
        let Some(mut level) = self.finished() else {
            return false;
        };
        level.id = self.free_id(&level);
        let is_new = !self.levels.iter().any(|known| known.id == level.id);
        if is_new && self.has_all_own_levels() {
            self.notify((self.making().own_full)(MOST_LEVELS));
            return false;
        }
        self.maker.draft.set_id(&level.id);
        let text = self.maker.draft.text();
        if text.is_empty() || text.len() as u64 > MAX_KEPT_BYTES {
            self.notify(self.making().not_kept.to_string());
            return false;
        }
        let level = Arc::new(level);
        self.levels.retain(|known| known.id != level.id);
        self.levels.push(level.clone());
        self.files.keep_level_text(&level.id, text);
        self.maker.saved = Some(level.scene().clone());
        // From now on, this is the player's own level.
        self.maker.origin = None;
        if let Some(won) = self.maker.win_of(&level) {
            self.files.keep_best(&level, won);
        }
        self.notify(self.making().kept.to_string());
        true
    }

    /// Adds a copy of an own level.
    pub fn duplicate(&mut self, index: usize) {
        let mut level = Level::clone(&self.levels[index]);
        let text = self.text_of(&level);
        let mut draft = Draft::of_level(&level, text.as_deref());
        for language in [Language::English, Language::Japanese] {
            let name = draft.name(language).to_string();
            if !name.is_empty() {
                draft.set_name(language, &format!("{name} 2"));
            }
        }
        if !is_made_here(&level.id) {
            draft.set_origin(&origin_of(&level));
        }
        if self.has_all_own_levels() {
            return self.notify((self.making().own_full)(MOST_LEVELS));
        }
        let copy = match draft.level() {
            Ok(copy) => copy,
            Err(error) => return self.notify(self.told(&error)),
        };
        level = copy;
        level.id = self.new_id();
        self.files.keep_level_text(&level.id, draft.text());
        self.levels.push(Arc::new(level));
    }

    /// Returns the id under which a level is kept: that of the own level that was changed, or a new one.
    fn free_id(&self, level: &Level) -> String {
        let is_own = self.maker.origin.is_none() && is_made_here(&level.id);
        match is_own {
            true => level.id.clone(),
            false => self.new_id(),
        }
    }

    /// Returns an id that no level has, not even one that was removed.
    fn new_id(&self) -> String {
        let numbered = (1..).map(|number| format!("{MADE_HERE}{number}"));
        let mut free = numbered.filter(|id| !self.is_taken(id));
        free.next().expect("there are more numbers than levels")
    }

    /// Copies a link to the level, with the maker's own round as a ghost to race if there is one.
    pub fn copy_link_to_draft(&mut self) {
        let Some(level) = self.finished() else {
            return;
        };
        // A round that is too long for a link is left out.
        let link = self.maker.win_of(&level).and_then(|won| won.link().ok());
        self.copy(link.map_or_else(|| level.link(), Ok));
    }

    /// Returns the QR code of the link to the level. `None` if the level is too large for one.
    pub fn code_of_draft(&mut self) -> Option<Code> {
        if self.maker.summary().code.is_none() {
            let credited = self.maker.credited(&self.settings.maker_name);
            let level = Level::from_scene(self.maker.draft.id(), credited).ok();
            let code = level.and_then(|level| Code::of_level(&address_of_page(), &level));
            self.maker.summary().code = Some(code);
        }
        self.maker.summary().code.clone().flatten()
    }

    /// Whether links lead to a page, so that a phone can open their QR codes.
    pub fn has_page(&self) -> bool {
        !address_of_page().is_empty()
    }

    /// Keeps the level, and gives it to the player as a file or tells where its file is.
    pub fn save_draft_file(&mut self) {
        if self.keep_draft() {
            let (id, text) = (self.maker.draft.id().to_string(), self.maker.draft.text());
            self.files.save_level(&id, text);
        }
    }

    /// Whether the level that was left in the editor has changes that were not kept.
    pub fn has_unsaved_level(&self) -> bool {
        let maker = &self.maker;
        maker.saved.as_ref() != Some(maker.draft.scene())
    }

    /// Leaves the editor. A new or own level is kept. A changed copy of another level, and one that cannot be played yet,
    /// stays in the making until another level is opened.
    pub fn leave_editor(&mut self) {
        self.end_drag();
        let is_own = self.maker.origin.is_none();
        let is_kept = is_own && self.has_unsaved_level() && self.keep_draft();
        if !is_kept && self.has_unsaved_level() {
            self.notify(self.making().still_open.to_string());
        }
        self.screens.close(Screen::Editor);
        self.arrive();
    }
}

/// Returns who made a level and from which one it was made, as lines for the player.
pub fn credits(level: &Level, words: &MakingWords) -> Vec<String> {
    let game = level.game();
    let line = |name: &Option<String>, most: usize, told: fn(&str) -> String| {
        let name = plain(name.as_deref()?, most);
        (!name.is_empty()).then(|| told(&name))
    };
    let lines = [
        line(&game.made_by, MOST_NAME, words.by),
        // The names of a level and of its maker, in brackets.
        line(&game.changed_from, 2 * MOST_NAME + 3, words.changed_from),
    ];
    lines.into_iter().flatten().collect()
}

/// Returns the name of a level and of its maker, as the origin of another level.
pub(super) fn origin_of(level: &Level) -> String {
    let game = level.game();
    let name = cleaned(&game.name.en);
    match game.made_by.as_deref().map(cleaned) {
        Some(maker) if !maker.is_empty() => format!("{name} ({maker})"),
        _ => name,
    }
}

/// Returns a name that other people chose as plain text: without control characters and without characters that change
/// the direction of writing, with single spaces, and at most [`MOST_NAME`] characters long.
pub fn cleaned(name: &str) -> String {
    plain(name, MOST_NAME)
}

/// Returns plain text as [`cleaned`] does, at most `most` characters long.
fn plain(name: &str, most: usize) -> String {
    let plain = without_marks(&name.replace('\t', " "));
    let words = plain.split_whitespace().collect::<Vec<_>>().join(" ");
    let cut: String = words.chars().take(most).collect();
    cut.trim_end().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_others_become_plain_text() {
        for (name, expected) in [
            ("Mika", "Mika"),
            ("  two\twords \n", "two words"),
            ("\u{202e}evil\u{200f}", "evil"),
            ("\u{7}", ""),
            ("みか", "みか"),
        ] {
            assert_eq!(cleaned(name), expected, "{name:?}");
        }
        assert_eq!(cleaned(&"x".repeat(100)).len(), MOST_NAME);
    }
}
