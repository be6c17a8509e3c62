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
