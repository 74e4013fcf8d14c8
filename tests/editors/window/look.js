// Opens a spec in VS Code in a browser, and prints what a person sees there as JSON.
// Arguments: URL of code-server, file for a screenshot, a spec in the folder; then what to look for:
// "language TEXT": its problems, and what is offered where TEXT is written at its end; or "message".
const { chromium } = require("playwright-core");

const [, , url, picture, spec, wanted, typed] = process.argv;
const PATIENCE = 60_000;

async function labels(page, selector) {
  await page.waitForSelector(selector, { timeout: PATIENCE });
  return page.$$eval(selector, (rows) => rows.map((row) => row.getAttribute("aria-label") ?? row.textContent));
}

async function run(page, command) {
  await page.keyboard.press("F1");
  await page.waitForSelector(".quick-input-widget:not([style*='display: none'])");
  await page.keyboard.type(command);
  await page.click(`.quick-input-list .monaco-list-row[aria-label^="${command}"]`);
}

async function open(page) {
  await page.goto(url);
  const row = `.explorer-folders-view .monaco-list-row[aria-label^="${spec}"]`;
  await page.click(row, { timeout: PATIENCE, clickCount: 2 });
  await page.waitForSelector(".monaco-editor .view-line");
}

async function language(page) {
  await run(page, "Problems: Focus on Problems View");
  const problems = await labels(page, ".markers-panel .monaco-list-row[aria-level='2']");
  await page.click(".monaco-editor .view-line");
  await page.keyboard.press("Control+End");
  await page.keyboard.type(typed);
  await page.waitForTimeout(2000); // the server gets the text
  await page.keyboard.press("Control+Space");
  const offered = await labels(page, ".suggest-widget.visible .monaco-list-row");
  const tokens = await page.$$eval(".view-line > span > span", (spans) => spans.map((span) => span.textContent));
  return { name: await page.textContent("#status\\.editor\\.mode"), problems, offered, tokens };
}

async function message(page) {
  return { messages: await labels(page, ".notifications-toasts .notification-list-item-message") };
}

chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] }).then(async (browser) => {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
  try {
    await open(page);
    console.log(JSON.stringify(await { language, message }[wanted](page)));
  } catch (error) {
    console.error(String(error));
    process.exitCode = 1;
  }
  await page.screenshot({ path: picture });
  await browser.close();
});
