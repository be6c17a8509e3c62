//! Making of bodies and levels: the paper, the block of voxels, and the level into which they go.

use super::sharing::Summary;
use super::{Editor, EditorOrigin, Game, Screen};
use crate::session::Session;
use egui::Vec2;
use fuwafuwa::Vec3;
use fuwafuwa_scenes::import::FileType;
use fuwafuwa_scenes::scene::{BodyText, Form, MAX_MATERIALS};
use fuwafuwa_scenes::{Scene, SceneError};
use std::collections::BTreeMap;
use std::sync::Arc;
use tamaire_maker::body;
use tamaire_maker::check::Check;
use tamaire_maker::draft::Draft;
use tamaire_maker::drawing::{Brush, Drawing, PAPER, Pieces};
use tamaire_maker::items::{self, Item};
use tamaire_maker::palette::{Palette, crayon};
use tamaire_play::Replay;
use tamaire_play::level::LevelError;
use tamaire_play::playground::Stuff;

/// Tool of a drawing.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub enum DrawingTool {
    /// Draws with the crayon.
    #[default]
    Crayon,
    /// Gives solid cells the crayon.
    Paint,
    /// Empties cells.
    Eraser,
    /// Fills an area that is enclosed.
    Bucket,
    /// Prints a shape.
    Stamp(Form),
}

/// Radii of the crayon [cells], as on a paper of 64 cells.
pub const WIDTHS: [f32; 3] = [1.25, 2.5, 4.5];
/// Size of a stamp in multiples of the diameter of the crayon.
const STAMP: f32 = 4.0;
/// Distance of a drawing from the floor when it is dropped [m].
const ABOVE_FLOOR: f32 = 0.02;
/// Direction from which a new block is seen: azimuth and elevation [rad].
const FRONT: [f32; 2] = [0.6, 0.45];
/// Factor on the radii of the paper in a block.
const IN_BLOCK: f32 = 0.7;

/// Weak points of a drawing: separate pieces and thin parts.
#[derive(Clone)]
pub struct Flaws {
    cells: Vec<u8>,
    /// Separate pieces.
    pub pieces: Pieces,
    /// Whether each cell is in a part that is so thin that it breaks at a touch.
    pub thin: Vec<bool>,
}

/// Destination of the drawing.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
enum Target {
    /// Into an empty room, as its only body.
    #[default]
    Room,
    /// Into the level in the editor, as a new body.
    NewBody,
    /// In place of the body of the level in the editor with this index.
    Body(usize),
}

/// Picture that was brought to the paper.
#[derive(Clone)]
pub struct PaperPicture {
    name: String,
    bytes: Arc<[u8]>,
    /// Maximum number of cells along its longer side.
    pub across: usize,
    /// Palette before the step of undo that the current drag of the slider has made. `None` = the next change is a new step.
    before_drag: Option<Palette>,
}

impl PaperPicture {
    /// Notes that the slider is not dragged.
    pub fn end_drag(&mut self) {
        self.before_drag = None;
    }
}

/// Reason why a drawing is not put into a level.
enum NotPut {
    /// Nothing is drawn.
    Empty,
    /// The level can have no further body or material.
    NoSpace,
}

/// The drawing in the making, and the level into which it goes.
pub struct Maker {
    /// Drawing on the paper.
    pub paper: Drawing,
    /// Body of voxels.
    pub block: Drawing,
    flaws: Flaws,
    /// Whether the block is shown, otherwise the paper.
    pub shows_block: bool,
    /// Materials of the drawings.
    pub palette: Palette,
    /// Number of the chosen crayon.
    pub crayon: u8,
    /// Chosen tool.
    pub tool: DrawingTool,
    /// Index of the width of the crayon in [`WIDTHS`].
    pub width: usize,
    /// Direction from which the block is seen: azimuth and elevation [rad].
    pub angles: [f32; 2],
    /// End of the stroke that is being drawn [cells]. `None` between strokes, and while a stroke leaves the drawing.
    pub pen: Option<Vec3>,
    /// Block before the stroke that is being drawn. A stroke follows this surface, so that it does not grow towards the
    /// player.
    pub before_stroke: Option<Drawing>,
    /// Whether a stroke is being drawn.
    is_drawing: bool,
    /// Whether the sheet has the focus of a player with keys or a pad.
    pub is_sheet_on: bool,
    /// Cursor of players without a pointer [cells]; `None` while it is not used.
    pub cursor: Option<Cursor>,
    /// Empty room into which a drawing is dropped that was begun from the title.
    room: Draft,
    /// Level in the editor.
    pub draft: Draft,
    /// Destination of the drawing.
    target: Target,
    /// Edge length of a cell [m] in the body that is redrawn; `None` for the usual one.
    cell: Option<f32>,
    /// State of the editor.
    pub editor: Editor,
    /// Picture on the paper, until anything else changes the drawing.
    pub picture: Option<PaperPicture>,
    /// Name of the level as it is being typed.
    pub typed_name: Option<String>,
    /// Name of the level from which this one is made, unless it is the player's own.
    pub origin: Option<String>,
    /// Screen to which Back leads from the editor, unless it is the next one in the stack.
    pub(super) came_from: Option<EditorOrigin>,
    /// Scene of the level when it was opened or kept last. `None` for a room that was never kept.
    pub saved: Option<Scene>,
    /// Checks of the level, from when they are first shown.
    pub check: Option<Check>,
    /// Summary of the level in the editor, for the page on which it is finished.
    pub(super) summary: Option<Summary>,
    /// Shortest win of the level by its maker.
    pub won: Option<Replay>,
    /// Whether the QR code is shown.
    pub shows_code: bool,
}

/// Cursor on the paper for players with keys, a pad or one switch.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Cursor {
    /// Position on the sheet, each coordinate from 0 to 1, from its upper left corner.
    pub at: Vec2,
    /// Whether the pen is down.
    pub is_down: bool,
    /// Axis along which the cursor sweeps for a player with one switch.
    pub sweep: Option<usize>,
}

/// Paper and block, the materials on them, and the picture on the paper.
pub struct Sheets {
    paper: Drawing,
    block: Drawing,
    palette: Palette,
    shows_block: bool,
    picture: Option<PaperPicture>,
}

impl Default for Maker {
    fn default() -> Self {
        Self {
            paper: Drawing::paper(),
            block: Drawing::block(),
            flaws: Flaws {
                cells: Vec::new(),
                pieces: Drawing::paper().pieces(),
                thin: Vec::new(),
            },
            shows_block: false,
            palette: Palette::default(),
            crayon: 1,
            tool: DrawingTool::default(),
            width: 1,
            angles: FRONT,
            pen: None,
            before_stroke: None,
            is_drawing: false,
            is_sheet_on: false,
            cursor: None,
            room: Draft::blank(2),
            draft: Draft::blank(2),
            target: Target::Room,
            cell: None,
            editor: Editor::new(),
            picture: None,
            typed_name: None,
            saved: Some(Draft::blank(2).scene().clone()),
            origin: None,
            came_from: None,
            check: None,
            summary: None,
            won: None,
            shows_code: false,
        }
    }
}

impl Maker {
    /// Returns the drawing that is shown.
    pub fn drawing(&self) -> &Drawing {
        match self.shows_block {
            true => &self.block,
            false => &self.paper,
        }
    }

    /// Returns the pieces and the thin cells of the drawing that is shown. They are computed again when cells have changed.
    pub fn flaws(&mut self) -> &Flaws {
        let drawing = match self.shows_block {
            true => &self.block,
            false => &self.paper,
        };
        if self.flaws.cells != drawing.cells() {
            self.flaws = Flaws {
                cells: drawing.cells().to_vec(),
                pieces: drawing.pieces(),
                thin: drawing.thin_cells(),
            };
        }
        &self.flaws
    }

    /// Returns the drawing that is shown, to change it.
    pub fn drawing_mut(&mut self) -> &mut Drawing {
        match self.shows_block {
            true => &mut self.block,
            false => &mut self.paper,
        }
    }

    /// Radius of the crayon [cells], at the usual pressure.
    pub fn radius(&self) -> f32 {
        let scale = if self.shows_block { IN_BLOCK } else { 1.0 };
        scale * WIDTHS[self.width.min(WIDTHS.len() - 1)]
    }

    /// Width of a stamp [cells].
    pub fn stamp_width(&self) -> f32 {
        2.0 * STAMP * self.radius()
    }

    /// Draws from the last point of the stroke to `at` [cells] with the chosen tool. `pressure` is the factor on the width of
    /// the stroke, 1 without a pen that feels pressure. Returns whether anything has changed.
    pub fn draw_to(&mut self, at: Vec3, pressure: f32) -> bool {
        let (tool, crayon, radius) = (self.tool, self.crayon, pressure * self.radius());
        let (from, width) = (self.pen.unwrap_or(at), self.stamp_width());
        let begins = !std::mem::replace(&mut self.is_drawing, true);
        self.picture = None;
        self.pen = Some(at);
        let drawing = self.drawing_mut();
        match tool {
            DrawingTool::Crayon => drawing.stroke(from, at, radius, Brush::Draw(crayon)),
            DrawingTool::Paint => drawing.stroke(from, at, radius, Brush::Paint(crayon)),
            DrawingTool::Eraser => drawing.stroke(from, at, radius, Brush::Erase),
            DrawingTool::Bucket if begins => {
                let cell = at.floor().to_array().map(|k| k as i32);
                drawing.fill(cell, crayon)
            }
            DrawingTool::Stamp(form) if begins => drawing.stamp(form, at, pressure * width, crayon),
            DrawingTool::Bucket | DrawingTool::Stamp(_) => false,
        }
    }

    /// Whether a stroke is being drawn.
    pub fn is_drawing(&self) -> bool {
        self.is_drawing
    }

    /// Ends the stroke.
    pub fn lift_pen(&mut self) {
        (self.pen, self.before_stroke) = (None, None);
        if std::mem::take(&mut self.is_drawing) {
            self.drawing_mut().end_stroke();
        }
    }

    /// Whether the drawing may become a body in 3D: it is alone, or its level is in 3D.
    pub fn may_turn_solid(&self) -> bool {
        self.is_alone() || self.draft.scene().dim == 3
    }

    /// Whether the drawing goes into an empty room.
    pub fn is_alone(&self) -> bool {
        self.target == Target::Room
    }

    /// Whether the drawing that is shown has the dimension of its level: a level in 3D takes blocks, a flat one takes paper.
    pub fn may_drop(&self) -> bool {
        self.is_alone() || (self.draft.scene().dim == 3) == self.shows_block
    }

    /// Shows the paper or the block.
    pub fn show_block(&mut self, shows_block: bool) {
        self.lift_pen();
        (self.cursor, self.picture) = (None, None);
        self.shows_block = shows_block;
        if shows_block && self.tool == DrawingTool::Bucket {
            self.tool = DrawingTool::Crayon;
        }
    }

    /// Makes the drawing on the paper a block, and shows it.
    pub fn make_solid(&mut self, made: impl Fn(&Drawing) -> Drawing) {
        self.lift_pen();
        if !self.paper.is_empty() {
            self.block.replace(&made(&self.paper));
            self.angles = FRONT;
        }
        self.show_block(true);
    }

    /// Puts the drawing into an empty room, or into the level in the editor.
    fn put_drawing(&mut self) -> Result<(), NotPut> {
        self.lift_pen();
        if self.drawing().is_empty() {
            return Err(NotPut::Empty);
        }
        if self.is_alone() {
            self.room = Draft::blank(if self.shows_block { 3 } else { 2 });
        }
        let (drawing, palette) = (self.drawing().without_history(), self.palette.clone());
        let (draft, body) = match self.target {
            // The drawing takes the place of the body of the empty room.
            Target::Room => (&mut self.room, Some(0)),
            Target::NewBody => (&mut self.draft, None),
            Target::Body(body) => (&mut self.draft, Some(body)),
        };
        let [low, high] = draft.scene().view.map(Vec3::from);
        let middle = 0.5 * (low + high);
        let stands = !matches!(self.target, Target::Body(_));
        let place = (middle, self.cell);
        let put = draft.change(|scene| {
            let put = body::put(scene, body, &drawing, &palette, place)?;
            items::tie_again(scene, put);
            if stands {
                // It stands on the floor of the room, so that it does not break in a fall.
                scene.body[put].at[1] = low.y + ABOVE_FLOOR;
            }
            Some(put)
        });
        let put = put.ok_or(NotPut::NoSpace)?;
        if !self.is_alone() {
            self.target = Target::Body(put);
        }
        Ok(())
    }

    /// Makes the room with the drawing the level in the editor. If nothing is drawn, the room is the one before.
    pub(super) fn take_room(&mut self) {
        self.put_drawing().ok();
        self.draft = self.room.clone();
        self.draft.restart(|_| {});
    }

    /// Returns what is on the sheets.
    pub(super) fn sheets(&self) -> Sheets {
        Sheets {
            paper: self.paper.clone(),
            block: self.block.clone(),
            palette: self.palette.clone(),
            shows_block: self.shows_block,
            picture: self.picture.clone(),
        }
    }

    /// Lays out other sheets.
    pub(super) fn lay_out(&mut self, sheets: Sheets) {
        (self.paper, self.block) = (sheets.paper, sheets.block);
        self.palette = sheets.palette;
        self.show_block(sheets.shows_block);
        self.picture = sheets.picture;
    }

    /// Empties both sheets, and forgets all materials except the crayons.
    fn take_new_sheets(&mut self) {
        (self.paper, self.block) = (Drawing::paper(), Drawing::block());
        self.palette = Palette::default();
    }

    /// Makes space in a palette that is nearly full: forgets materials that are on no sheet, and with them the steps of undo.
    fn make_space_in_palette(&mut self) {
        /// Number of materials that a picture may add.
        const SPARE: usize = 16;
        if self.palette.materials().len() + SPARE <= MAX_MATERIALS {
            return;
        }
        let mut is_used = [false; 256];
        for &cell in self.paper.cells().iter().chain(self.block.cells()) {
            is_used[usize::from(cell)] = true;
        }
        let (palette, numbers) = self.palette.with_used(&is_used);
        self.palette = palette;
        for sheet in [&mut self.paper, &mut self.block] {
            *sheet = sheet.renumbered(&numbers);
        }
    }
}

impl Game {
    /// Opens the paper for a drawing that is dropped into an empty room.
    pub fn open_paper(&mut self) {
        self.maker.target = Target::Room;
        self.maker.cell = None;
        self.maker.tool = DrawingTool::Crayon;
        self.go(Screen::Paper);
    }

    /// Drops the drawing into the room and starts a round there.
    pub fn drop_drawing(&mut self) {
        if !self.maker.may_drop() {
            let words = self.making();
            let told = match self.maker.shows_block {
                true => words.flat_level,
                false => words.make_block_first,
            };
            return self.notify(told.to_string());
        }
        if let Err(reason) = self.maker.put_drawing() {
            let words = self.making();
            let told = match reason {
                NotPut::Empty => words.draw_first,
                NotPut::NoSpace => words.level_full,
            };
            return self.notify(told.to_string());
        }
        if let Target::Body(body) = self.maker.target {
            self.go(Screen::Editor);
            return self.select(Item::Body(body));
        }
        match self.maker.room.level() {
            Ok(level) => {
                self.bout.camera.face_front();
                self.begin(Session::of_people(Arc::new(level)));
            }
            Err(error) => self.notify(self.told(&error)),
        }
    }

    /// Draws a picture or model on the paper or as a block.
    pub fn draw_picture(&mut self, name: String, bytes: Vec<u8>) {
        self.maker.make_space_in_palette();
        let picture = PaperPicture {
            name,
            bytes: bytes.into(),
            across: PAPER,
            before_drag: None,
        };
        self.show_picture(picture, false);
    }

    /// Draws the picture on the paper again, at most `across` cells wide and high. All changes of one drag of the slider are
    /// one step of undo.
    pub fn redraw_picture(&mut self, across: usize, is_drag: bool) {
        let Some(mut picture) = self.maker.picture.take() else {
            return;
        };
        let before = picture.before_drag.take().filter(|_| is_drag);
        let is_same_step = before.is_some();
        match before {
            Some(palette) => self.maker.palette = palette,
            None => self.maker.make_space_in_palette(),
        }
        picture.before_drag = is_drag.then(|| self.maker.palette.clone());
        picture.across = across;
        self.show_picture(picture, is_same_step);
    }

    /// Draws a picture, as a new step of undo or in place of the last one.
    fn show_picture(&mut self, mut picture: PaperPicture, is_same_step: bool) {
        match imported(&picture, &mut self.maker.palette) {
            Ok((scene, drawing)) => {
                let maker = &mut self.maker;
                maker.show_block(!drawing.is_paper());
                if is_same_step {
                    maker.drawing_mut().replace_again(&drawing);
                } else if !maker.drawing_mut().replace(&drawing) {
                    // An equal drawing is no step that further changes could replace.
                    picture.end_drag();
                }
                let notes = scene.notes().iter().map(self.words().import_note);
                notes.for_each(|note| self.notices.tell(&note));
                self.maker.picture = drawing.is_paper().then_some(picture);
            }
            Err(error) => self.notify(self.told(&LevelError::Scene(error))),
        }
    }

    /// Opens the paper with the selected body.
    pub fn draw_selected(&mut self) {
        let Some(Item::Body(index)) = self.main_item() else {
            return;
        };
        let maker = &mut self.maker;
        let mut palette = Palette::default();
        match body::take(maker.draft.scene(), index, &mut palette) {
            Ok(Some(taken)) => {
                maker.take_new_sheets();
                maker.palette = palette;
                maker.show_block(!taken.drawing.is_paper());
                *maker.drawing_mut() = taken.drawing;
                (maker.target, maker.cell) = (Target::Body(index), Some(taken.cell));
                self.go(Screen::Paper);
            }
            Ok(None) => {}
            Err(error) => self.notify(self.told(&LevelError::Scene(error))),
        }
    }

    /// Opens the paper for a new body of the level.
    pub fn draw_new_body(&mut self) {
        let maker = &mut self.maker;
        maker.show_block(maker.draft.scene().dim == 3);
        maker.take_new_sheets();
        (maker.target, maker.cell) = (Target::NewBody, None);
        self.go(Screen::Paper);
    }

    /// Whether the current round is played with the player's drawing.
    pub fn is_with_drawing(&self) -> bool {
        self.screens.has(Screen::Paper) && self.bout.session.is_played()
    }
}

/// Returns the drawing of a picture or model, with the scene into which it was read. Its colours are added to the palette.
fn imported(picture: &PaperPicture, palette: &mut Palette) -> Result<(Scene, Drawing), SceneError> {
    let PaperPicture {
        name,
        bytes,
        across,
        ..
    } = picture;
    let is_model = FileType::of(bytes) == FileType::Vox;
    let dim = if is_model { 3 } else { 2 };
    let mut scene = Scene::read(name, &format!("dim = {dim}\nmaterial = []"), &[])?;
    scene.material.push(crayon(Stuff::Jelly));
    scene.body.push(BodyText {
        file: Some(name.clone()),
        n: (!is_model).then_some(*across),
        keep_colours: (!is_model).then_some(true),
        colours: match is_model {
            true => (1..=u8::MAX).map(|index| (index.to_string(), 1)).collect(),
            false => BTreeMap::new(),
        },
        ..BodyText::default()
    });
    scene.embed_files(&|_| Ok(bytes.to_vec()))?;
    let taken = body::take(&scene, 0, palette)?;
    let drawing = taken.map_or_else(Drawing::paper, |taken| taken.drawing);
    Ok((scene, drawing))
}
