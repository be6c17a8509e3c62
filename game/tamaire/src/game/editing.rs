//! Editing of a level: selection, drags, and the room that shows the level.

use super::making::Sheets;
use super::sharing::{is_made_here, origin_of};
use super::{Game, Screen};
use crate::session::Session;
use fuwafuwa::Vec3;
use fuwafuwa_scenes::Scene;
use std::sync::{Arc, Weak};
use tamaire_maker::draft::Draft;
use tamaire_maker::items::{self, Clip, Dropped, Guide, Item, Kind};
use tamaire_play::Level;

/// Distance between two lines of the grid to which things snap [m].
pub const GRID: f32 = 0.05;
/// Angle of a step in which things turn [rad].
pub const TURN: f32 = std::f32::consts::PI / 12.0;
/// Factor by which a button makes things larger.
const LARGER: f32 = 1.15;
/// Distance of a pasted copy from its original [m].
const BESIDE: f32 = 0.15;
/// Speed at which time runs back after a test, in multiples of real time.
const HOMEWARD: f32 = 6.0;
/// Time that showing a changed room may take while something is dragged [s]. In a level that takes longer, things
/// move when they are let go.
const QUICK: f64 = 0.03;

/// Part of the editor below the room.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum EditorPart {
    /// Things to add.
    #[default]
    Things,
    /// Actions on the selection.
    Selection,
}

/// State of the editor.
#[derive(Default)]
pub struct Editor {
    /// Selected items.
    pub selection: Vec<Item>,
    /// Copied items.
    clip: Option<Clip>,
    /// Whether a press adds to the selection.
    pub is_adding: bool,
    /// Whether a drag in 3D moves things up and down.
    pub lifts: bool,
    /// Whether the arrow keys move the selection instead of the focus.
    pub moves_by_keys: bool,
    /// Whether things snap to the grid and to each other.
    pub snaps: bool,
    /// Drag in progress.
    pub drag: Option<Drag>,
    /// Selection after the drag that turns it: what was an obstacle may become a rigid body.
    pub turned: Option<Vec<Item>>,
    /// Lines on which the dragged things align with others.
    pub guides: Vec<Guide>,
    /// Selections at earlier states of the level, which undo and redo restore.
    remembered: Vec<(Weak<Scene>, Vec<Item>)>,
    /// Number of levels that the editor has opened. Its strip begins at the start for each of them.
    pub opened: u32,
    /// Part that is shown.
    pub part: EditorPart,
    /// Reason why the level cannot be played.
    pub problem: Option<String>,
    /// Whether showing a changed room takes too long for each frame of a drag.
    is_slow: bool,
    /// Whether the round in the room is a test of the level, which returns to the editor.
    is_test: bool,
    /// Whether time runs back from a test to the editor.
    returns: bool,
}

/// Screen to which Back leads from the editor, if it is not the next one in the stack.
pub enum EditorOrigin {
    /// The paper, with the sheets that it had.
    Paper(Box<Sheets>),
    /// The pause menu of a round in this level. A replay, or a race against a chosen ghost, begins again there.
    Round(Arc<Level>, Option<Box<Session>>),
    /// The list, where the name of a level was to be changed: Back leads there from the page *Finish* as well.
    Rename,
}

/// Drag of the selection.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Drag {
    /// Moves the selection from a point [m].
    Move(Vec3),
    /// Stretches the selection about a point [m], with the handle at another one.
    Stretch(Vec3, Vec3),
    /// Turns the selection about a point [m], with the handle at another one.
    Turn(Vec3, Vec3),
    /// Moves an end of a rope or spring: the index of the joint, that of the end, and its position before [m].
    End(usize, usize, Vec3),
    /// Selects what is in a frame, from a point [m].
    Frame(Vec3),
}

impl Editor {
    /// Creates the state at the start of the game.
    pub(super) fn new() -> Self {
        Self {
            snaps: true,
            ..Self::default()
        }
    }

    /// Notes that the round in the room is not a test.
    pub(super) fn end_test(&mut self) {
        (self.is_test, self.returns) = (false, false);
    }

    /// Whether an item of the level as it is shown is selected.
    pub fn is_selected(&self, item: Item) -> bool {
        self.turned
            .as_ref()
            .unwrap_or(&self.selection)
            .contains(&item)
    }

    /// Remembers the selection in a state of the level.
    fn remember(&mut self, scene: &Arc<Scene>) {
        let remembered = &mut self.remembered;
        remembered.retain(|(known, _)| known.strong_count() > 0 && !is_same_scene(known, scene));
        remembered.push((Arc::downgrade(scene), self.selection.clone()));
    }

    /// Restores the selection that was remembered for a state of the level, or selects nothing.
    fn recall(&mut self, scene: &Arc<Scene>) {
        let mut remembered = self.remembered.iter();
        let found = remembered.find(|(known, _)| is_same_scene(known, scene));
        self.selection = found.map_or_else(Vec::new, |(_, items)| items.clone());
    }

    /// Adds items to the selection that are not selected yet.
    fn select_also(&mut self, items: Vec<Item>) {
        for item in items {
            if !self.selection.contains(&item) {
                self.selection.push(item);
            }
        }
    }

    /// Forgets everything except what was copied and whether things snap.
    fn reset(&mut self) {
        let snaps = self.snaps;
        *self = Self {
            clip: self.clip.take(),
            opened: self.opened.wrapping_add(1),
            snaps,
            ..Self::default()
        };
    }
}

impl Game {
    /// Opens the editor with a level of the list.
    pub fn edit(&mut self, index: usize) {
        let mut level = self.levels[index].clone();
        self.keep_replaced_level();
        if let Some(newer) = self.levels.iter().find(|newer| newer.id == level.id) {
            level = newer.clone();
        }
        self.edit_level(&level);
        if is_made_here(&level.id) {
            self.maker.origin = None;
            self.maker.won = self.files.best(&level);
        }
    }

    /// Opens the editor with a copy of a level, or with an own level itself.
    pub fn edit_level(&mut self, level: &Level) {
        self.keep_replaced_level();
        let text = self.text_of(level);
        self.maker.draft = Draft::of_level(level, text.as_deref());
        self.begin_editing(Some(origin_of(level)));
    }

    /// Opens the editor with an empty room in 2D or 3D.
    pub fn edit_blank(&mut self, dim: u8) {
        self.keep_replaced_level();
        self.maker.draft = Draft::blank(dim);
        self.number_name();
        self.begin_editing(None);
    }

    /// Goes on with the level that was left without being kept.
    pub fn go_on_editing(&mut self) {
        self.maker.came_from = None;
        self.go(Screen::Editor);
    }

    /// Opens the editor with the level of the current round.
    pub fn edit_current(&mut self) {
        let level = self.bout.round().level().clone();
        let session = &self.bout.session;
        let is_new_round = session.is_played() && !self.bout.is_ghost_chosen;
        let session = (!is_new_round).then(|| Box::new(session.again()));
        match self.listed(&level) {
            Some(index) => self.edit(index),
            None => self.edit_level(&level),
        }
        self.maker.came_from = Some(EditorOrigin::Round(level, session));
    }

    /// Opens the page on which a level of the list gets another name.
    pub fn rename(&mut self, index: usize) {
        self.edit(index);
        self.maker.came_from = Some(EditorOrigin::Rename);
        self.go(Screen::Finish);
    }

    /// Whether a level of the list was made here, so that it can be renamed.
    pub fn can_rename(&self, index: usize) -> bool {
        is_made_here(&self.levels[index].id)
    }

    /// Leaves the page *Finish* to the editor, or to the list if it was opened there.
    pub fn leave_finish(&mut self) {
        match self.maker.came_from {
            Some(EditorOrigin::Rename) => self.leave_editor(),
            _ => self.go_back(),
        }
    }

    /// Selects everything.
    pub fn select_all(&mut self) {
        self.maker.editor.selection = items::items(self.maker.draft.scene());
        self.maker.editor.part = EditorPart::Selection;
    }

    /// Makes what was previewed a step of undo.
    pub fn settle_preview(&mut self) {
        if self.maker.draft.settle() {
            self.forget_gone();
            // The room shows the preview, unless that took too long.
            if self.maker.editor.is_slow {
                self.show_draft();
            }
        }
    }

    /// Opens the editor with the room of the drawing.
    pub fn edit_room(&mut self) {
        let is_on_paper = self.screens.has(Screen::Paper);
        self.keep_replaced_level();
        self.maker.lift_pen();
        let sheets = is_on_paper.then(|| Box::new(self.maker.sheets()));
        self.maker.take_room();
        self.number_name();
        self.begin_editing(None);
        self.maker.came_from = sheets.map(EditorOrigin::Paper);
        // The room was never kept.
        self.maker.saved = None;
    }

    /// Opens the editor with a new draft, made from the level `origin` if that is not the player's own.
    fn begin_editing(&mut self, origin: Option<String>) {
        let maker = &mut self.maker;
        (maker.won, maker.check, maker.typed_name) = (None, None, None);
        (maker.origin, maker.came_from) = (origin, None);
        maker.saved = Some(maker.draft.scene().clone());
        maker.editor.reset();
        self.go(Screen::Editor);
    }

    /// Gives a new level a name that no other level of the player has.
    fn number_name(&mut self) {
        let mut draft = self.maker.draft.clone();
        self.take_free_name(&mut draft, 1);
        self.maker.draft = draft;
    }

    /// Goes back to where the editor was opened, after it was closed.
    pub(super) fn return_from_editor(&mut self) {
        match self.maker.came_from.take() {
            Some(EditorOrigin::Paper(sheets)) => {
                self.maker.lay_out(*sheets);
                self.open_paper();
            }
            Some(EditorOrigin::Round(_, Some(session))) => {
                let is_race = session.is_played();
                self.begin(*session);
                self.bout.is_ghost_chosen = is_race;
                self.go(Screen::Paused);
            }
            Some(EditorOrigin::Round(level, None)) => {
                // An own level may have been changed. It has kept its id.
                let draft = &self.maker.draft;
                let is_own = self.maker.origin.is_none() && draft.id() == level.id;
                let mut levels = self.levels.iter();
                let own = levels.find(|known| is_own && known.id == level.id);
                let listed = own.or_else(|| self.listed(&level).map(|index| &self.levels[index]));
                self.play(&listed.unwrap_or(&level).clone());
                self.go(Screen::Paused);
            }
            Some(EditorOrigin::Rename) | None => {}
        }
    }

    /// Returns the text of a level as its author wrote it, if it is known.
    pub(super) fn text_of(&self, level: &Level) -> Option<String> {
        let built_in = tamaire_play::level::built_in().find(|(id, _)| *id == level.id);
        let built_in = built_in.map(|(_, text)| text.to_string());
        built_in.or_else(|| self.files.level_text(&level.id))
    }

    /// Shows the level that is being edited in the room.
    pub fn show_draft(&mut self) {
        // A test may have shown elements.
        self.bout.elements = None;
        let began = self.clock.now();
        match self.maker.draft.level() {
            Ok(level) => {
                self.maker.editor.problem = None;
                let session = Session::of_people(Arc::new(level)).without_rewind();
                self.bout.show(session);
            }
            Err(error) => {
                self.maker.editor.problem = Some(self.told(&error));
            }
        }
        self.maker.editor.is_slow = self.clock.now() - began > QUICK;
    }

    /// Makes a change of the level, as one step of undo.
    pub fn change_level(&mut self, change: impl FnOnce(&mut Scene)) {
        self.remember_selection();
        self.maker.draft.change(change);
        self.settle();
    }

    /// Shows a change of the level that is not finished, such as that of a drag.
    pub fn preview_level(&mut self, change: impl FnOnce(&mut Scene)) {
        self.remember_selection();
        self.maker.draft.preview(change);
        if !self.maker.editor.is_slow {
            self.show_draft();
        }
    }

    /// Remembers the selection for undo. Called before each change.
    fn remember_selection(&mut self) {
        let maker = &mut self.maker;
        maker.editor.remember(maker.draft.shared_before());
    }

    /// Ends a drag.
    pub fn end_drag(&mut self) {
        if self.maker.editor.drag.take().is_some() {
            self.maker.draft.settle();
            if let Some(turned) = self.maker.editor.turned.take() {
                self.maker.editor.selection = turned;
            }
            self.settle();
        }
    }

    /// Ends a drag without its change.
    pub fn drop_drag(&mut self) {
        if self.maker.editor.drag.take().is_some() {
            self.maker.draft.forget_preview();
            self.maker.editor.turned = None;
            self.settle();
        }
    }

    /// Forgets selected items that are gone, and shows the level.
    fn settle(&mut self) {
        self.forget_gone();
        self.show_draft();
    }

    /// Forgets selected items that are gone.
    fn forget_gone(&mut self) {
        let known = items::items(self.maker.draft.scene());
        let editor = &mut self.maker.editor;
        editor.selection.retain(|item| known.contains(item));
        if editor.selection.is_empty() {
            editor.part = EditorPart::Things;
        }
    }

    /// Goes back to the level before the last change, or forward again.
    pub fn undo_edit(&mut self, forward: bool) {
        self.remember_selection();
        let has_changed = match forward {
            true => self.maker.draft.redo(),
            false => self.maker.draft.undo(),
        };
        if has_changed {
            let maker = &mut self.maker;
            maker.editor.recall(maker.draft.shared_before());
            self.settle();
        }
    }

    /// Selects an item with what belongs to it, or takes it out of the selection if presses add to it. If the item is already
    /// selected as a part of another one, it is selected alone.
    pub fn select(&mut self, item: Item) {
        let group = items::group_of(self.maker.draft.scene(), item);
        let editor = &mut self.maker.editor;
        let is_part = group.first() != Some(&item);
        let is_group = has_same_items(&editor.selection, &group);
        let chosen = if is_part && is_group {
            vec![item]
        } else {
            group
        };
        self.apply_selection(chosen);
    }

    /// Selects an item without what belongs to it.
    pub fn select_alone(&mut self, item: Item) {
        self.apply_selection(vec![item]);
    }

    /// Selects items. If presses add to the selection, adds them, or takes them out if all are selected.
    fn apply_selection(&mut self, items: Vec<Item>) {
        let editor = &mut self.maker.editor;
        let are_selected = items.iter().all(|item| editor.selection.contains(item));
        match (editor.is_adding, are_selected) {
            (true, true) => editor.selection.retain(|known| !items.contains(known)),
            (true, false) => editor.select_also(items),
            (false, _) => editor.selection = items,
        }
        editor.moves_by_keys &= !editor.selection.is_empty();
        editor.part = match editor.selection.is_empty() {
            true => EditorPart::Things,
            false => EditorPart::Selection,
        };
    }

    /// Selects the items that a drag of `item` moves. A selection that contains it stays; the main item of a group adds the
    /// rest of the group.
    pub fn select_to_drag(&mut self, item: Item) {
        let group = items::group_of(self.maker.draft.scene(), item);
        let editor = &mut self.maker.editor;
        if !editor.selection.contains(&item) {
            editor.selection = group;
        } else if group.first() == Some(&item) {
            editor.select_also(group);
        }
        editor.part = EditorPart::Selection;
    }

    /// Returns the selected item, or the main one of selected items that belong together.
    pub fn main_item(&self) -> Option<Item> {
        let selection = &self.maker.editor.selection;
        let &first = selection.first()?;
        let group = items::group_of(self.maker.draft.scene(), first);
        match selection.len() {
            1 => Some(first),
            _ => has_same_items(selection, &group).then(|| group[0]),
        }
    }

    /// Returns the name of an item of the level that is being edited.
    pub fn item_name(&self, item: Item) -> String {
        let number = items::numbers(self.maker.draft.scene()).remove(&item);
        self.numbered_name(item, number.unwrap_or(item.number()))
    }

    /// Returns the name of an item with its number among the items of its kind, see [`items::numbers`].
    pub fn numbered_name(&self, item: Item, number: usize) -> String {
        let kind = items::kind_of(self.maker.draft.scene(), item);
        (self.making().item_name)(kind, number)
    }

    /// Selects nothing.
    pub fn select_nothing(&mut self) {
        self.maker.editor.selection.clear();
        self.maker.editor.moves_by_keys = false;
        self.maker.editor.part = EditorPart::Things;
    }

    /// Makes a change that returns the items to be selected after it.
    fn change_and_select(&mut self, change: impl FnOnce(&mut Scene) -> Vec<Item>) {
        self.remember_selection();
        let selection = self.maker.draft.change(change);
        self.maker.editor.selection = selection;
        self.maker.editor.part = EditorPart::Selection;
        self.settle();
    }

    /// Adds something where there is most room, and selects it. A rope, spring or pin is tied to the selected thing, or to a
    /// body.
    pub fn add_thing(&mut self, kind: Kind) {
        let place = items::free_place(self.maker.draft.scene());
        let mut selected = self.maker.editor.selection.iter().copied();
        let holder = selected
            .find(|item| matches!(item, Item::Body(_) | Item::RigidBody(_) | Item::Hand(_)));
        self.change_and_select(|scene| items::add_to(scene, kind, place, holder));
        // The things to add stay where they are, so that a second press does not meet another button.
        self.maker.editor.part = EditorPart::Things;
        if self.maker.editor.selection.is_empty() {
            self.notify(self.making().not_pasted.to_string());
        }
    }

    /// Removes the selection.
    pub fn remove_selection(&mut self) {
        self.remember_selection();
        let selection = self.maker.editor.selection.clone();
        let removed = self
            .maker
            .draft
            .change(|scene| items::remove(scene, &selection));
        self.select_nothing();
        self.settle();
        if !removed.refused.is_empty() {
            self.notify(self.making().last_one_stays.to_string());
        }
        let (counted, goals): (Vec<&Dropped>, Vec<&Dropped>) =
            { removed.dropped.iter() }.partition(|dropped| matches!(dropped, Dropped::Counted(_)));
        if !goals.is_empty() {
            self.notify(self.making().goal_dropped.to_string());
        }
        if !counted.is_empty() {
            self.notify(self.making().all_count.to_string());
        }
    }

    /// Copies the selection.
    pub fn copy_selection(&mut self) {
        if self.maker.editor.selection.is_empty() {
            return;
        }
        let scene = self.maker.draft.scene();
        self.maker.editor.clip = Some(items::copy(scene, &self.maker.editor.selection));
        self.notify(self.making().copied.to_string());
    }

    /// Whether something was copied that fits into this level.
    pub fn can_paste(&self) -> bool {
        let dim = self.maker.draft.scene().dim;
        { self.maker.editor.clip.as_ref() }.is_some_and(|clip| clip.dim() == dim)
    }

    /// Pastes what was copied, and selects it.
    pub fn paste(&mut self) {
        let Some(clip) = self.maker.editor.clip.clone().filter(|_| self.can_paste()) else {
            return;
        };
        let by = Vec3::new(BESIDE, BESIDE, 0.0);
        self.change_and_select(|scene| items::paste(scene, &clip, by));
        if self.maker.editor.selection.is_empty() {
            self.notify(self.making().not_pasted.to_string());
        }
    }

    /// Returns the box around the selection [m].
    pub fn selection_box(&self) -> Option<[Vec3; 2]> {
        let scene = self.maker.draft.scene();
        let editor = &self.maker.editor;
        let selection = editor.turned.as_ref().unwrap_or(&editor.selection).iter();
        let boxes = selection.filter_map(|&item| items::bounds(scene, item));
        boxes.reduce(items::union)
    }

    /// Returns a displacement of the selection by which bodies, hands and baskets stay in the view.
    pub fn within_view(&self, by: Vec3) -> Vec3 {
        let scene = self.maker.draft.scene_before();
        let [low, high] = scene.view.map(Vec3::from);
        let stays = |item: &&Item| matches!(item, Item::Body(_) | Item::Hand(_) | Item::Basket(_));
        let boxes = self.maker.editor.selection.iter().filter(stays);
        let boxes = boxes.filter_map(|&item| items::bounds(scene, item));
        boxes.fold(by, |by, [from, to]| {
            // A thing that is partly outside is not pushed farther out.
            by.max((low - from).min(Vec3::ZERO))
                .min((high - to).max(Vec3::ZERO))
        })
    }

    /// Moves the selection by a step.
    pub fn nudge(&mut self, by: Vec3) {
        let by = self.within_view(by);
        let selection = self.maker.editor.selection.clone();
        self.change_level(|scene| items::translate(scene, &selection, by));
    }

    /// Turns the selection about its middle, in steps of 15°.
    pub fn turn_selection(&mut self, axis: Vec3, steps: f32) {
        if let Some([low, high]) = self.selection_box() {
            let selection = self.maker.editor.selection.clone();
            let about = 0.5 * (low + high);
            self.change_and_select(|scene| {
                items::rotate(scene, &selection, about, axis, steps * TURN)
            });
        }
    }

    /// Makes the selection larger, or smaller with a negative number of steps.
    pub fn scale_selection(&mut self, steps: i32) {
        if let Some([low, high]) = self.selection_box() {
            let selection = self.maker.editor.selection.clone();
            let (about, factor) = (0.5 * (low + high), LARGER.powi(steps));
            self.change_level(|scene| {
                items::stretch(scene, &selection, about, Vec3::splat(factor));
            });
        }
    }

    /// Plays the level that is being edited.
    pub fn test_level(&mut self) {
        self.end_drag();
        match self.maker.draft.level() {
            Ok(level) => {
                self.begin(Session::of_people(Arc::new(level)));
                self.maker.editor.is_test = true;
            }
            Err(error) => self.notify(self.told(&error)),
        }
    }

    /// Whether the current round is a test of the level that is being edited.
    pub fn is_test(&self) -> bool {
        self.screens.has(Screen::Editor) && self.maker.editor.is_test
    }

    /// Lets time run back from a test to the editor.
    pub fn end_test(&mut self) {
        self.go(Screen::Play);
        self.maker.editor.returns = true;
    }

    /// Returns the time by which a test runs back in a frame of `seconds` [s], on the way to the editor. `None` while no
    /// test ends.
    pub(super) fn homeward(&mut self, seconds: f32) -> Option<f32> {
        if !self.maker.editor.returns {
            return None;
        }
        let left = self.bout.session.seconds_to_rewind();
        if left <= 0.0 || self.settings.reduced_motion || !self.may_rewind() {
            self.maker.editor.returns = false;
            self.bout.session.run_forward();
            self.screens.close(Screen::Play);
            self.arrive();
            return None;
        }
        Some(HOMEWARD * seconds)
    }
}

/// Returns whether two lists have the same items.
fn has_same_items(one: &[Item], other: &[Item]) -> bool {
    one.len() == other.len() && one.iter().all(|item| other.contains(item))
}

/// Returns whether a weak reference is to a scene.
fn is_same_scene(known: &Weak<Scene>, scene: &Arc<Scene>) -> bool {
    std::ptr::eq(known.as_ptr(), Arc::as_ptr(scene))
}
