// The browsers that tests drive, without a display.
import { launch } from "puppeteer-core";

/** What one evaluation may take [ms]: a bot's minute, four times slower than here. */
const PATIENCE = 600_000;

/** Chromium, which draws by software where there is no GPU. */
export function chromium() {
  const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];
  return launch({ executablePath: "/usr/bin/chromium", args, protocolTimeout: PATIENCE });
}

/** Firefox ESR, by WebDriver BiDi. */
export function firefox() {
  return launch({ browser: "firefox", executablePath: "/usr/bin/firefox-esr", protocolTimeout: PATIENCE });
}
