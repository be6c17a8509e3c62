//! The way in through a browser: the page hands over a canvas and itself, and says when it goes away.

use crate::app::App;
use crate::game::Game;
use crate::platform::{Files, Host, Pads, Sound, set_host};
use eframe::{WebOptions, WebRunner};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::HtmlCanvasElement;

/// The game on a canvas.
#[wasm_bindgen]
pub struct Running {
    runner: WebRunner,
}

#[wasm_bindgen]
impl Running {
    /// Begins, and goes on until [`Running::end`].
    ///
    /// # Errors
    /// Why there is nothing to draw with.
    pub async fn start(canvas: HtmlCanvasElement, host: Host) -> Result<Running, JsValue> {
        set_host(host);
        let runner = WebRunner::new();
        let create = |context: &eframe::CreationContext<'_>| {
            let game = Game::new(Files::usual(), Sound::open(), Pads::open());
            Ok(Box::new(App::new(context, game)?) as Box<dyn eframe::App>)
        };
        runner
            .start(canvas, WebOptions::default(), Box::new(create))
            .await?;
        Ok(Self { runner })
    }

    /// How things stand, for whoever looks on: a test, or an exhibit.
    pub fn report(&self) -> Option<Report> {
        let app = self.runner.app_mut::<App>()?;
        let (game, round) = (&app.game, app.game.bout.round());
        let [hand, origin, right] = match game.bout.view {
            None => [[f32::NAN; 2]; 3],
            Some(view) => {
                let at = |place| <[f32; 2]>::from(view.on_screen(place) * app.zoom);
                [
                    at(round.hands()[0].position()),
                    at([0.0; 3]),
                    at([1.0, 0.0, 0.0]),
                ]
            }
        };
        Some(Report {
            screen: format!("{:?}", game.screen()),
            level: round.level().id.clone(),
            language: format!("{:?}", game.settings.language),
            ticks: round.ticks() as u32,
            is_won: round.progress().outcome.is_some(),
            won: { game.levels.iter() }
                .filter(|level| {
                    game.records
                        .of(&level.id)
                        .is_some_and(|record| !record.best.is_empty())
                })
                .map(|level| level.id.clone())
                .collect(),
            notices: game
                .notices
                .iter()
                .map(|notice| notice.text.clone())
                .collect(),
            hand: hand.into(),
            origin: origin.into(),
            right: right.into(),
        })
    }

    /// Writes what is still to be written: the page may not come back.
    pub fn flush(&self) {
        if let Some(mut app) = self.runner.app_mut::<App>() {
            app.game.finish_writing();
        }
    }

    /// Ends it because its GPU is lost. The round may be watched later.
    pub fn end(&self) {
        if let Some(mut app) = self.runner.app_mut::<App>() {
            app.game.rescue();
        }
        self.runner.destroy();
    }
}

/// How things stand. Places are in the pixels of the page.
#[wasm_bindgen(getter_with_clone)]
pub struct Report {
    /// What is seen.
    pub screen: String,
    /// The level of the round that is on.
    pub level: String,
    /// What the game speaks.
    pub language: String,
    /// How long the round has been going on [1/60 s].
    pub ticks: u32,
    /// Whether it is won.
    pub is_won: bool,
    /// The levels in which there is a record.
    pub won: Vec<String>,
    /// What the player is being told.
    pub notices: Vec<String>,
    /// Where the first hand is.
    pub hand: Vec<f32>,
    /// Where the middle of the world is.
    pub origin: Vec<f32>,
    /// And a place 1 m to the right of it.
    pub right: Vec<f32>,
}
