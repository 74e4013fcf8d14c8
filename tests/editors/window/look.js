// Opens a spec in VS Code in a browser, and prints what a person sees there as JSON.
// Arguments: URL of code-server, file for a screenshot, a spec in the folder, a text to write at its end.
const { chromium } = require("playwright-core");

const [, , url, picture, spec, typed] = process.argv;
const PATIENCE = 60_000;

async function labels(page, selector) {
  await page.waitForSelector(selector, { timeout: PATIENCE });
  return page.$$eval(selector, (rows) => rows.map((row) => row.getAttribute("aria-label") ?? row.textContent));
}

async function command(page, name) {
  await page.keyboard.press("F1");
  await page.waitForSelector(".quick-input-widget:not([style*='display: none'])");
  await page.keyboard.type(name);
  await page.waitForTimeout(1000);
  await page.keyboard.press("Enter");
}

async function look(page) {
  const problems = ".markers-panel .monaco-list-row[aria-level='2']";
  await page.goto(url);
  await page.waitForSelector(".monaco-workbench .explorer-folders-view", { timeout: PATIENCE });
  await page.click(`.explorer-folders-view .monaco-list-row[aria-label^="${spec}"]`, { timeout: PATIENCE, clickCount: 2 });
  await page.waitForSelector(".monaco-editor .view-line");
  const language = await page.textContent("#status\\.editor\\.mode", { timeout: PATIENCE });
  await command(page, "Problems: Focus on Problems View");
  const shown = await labels(page, problems);
  await page.click(".monaco-editor .view-line");
  await page.keyboard.press("Control+End");
  await page.keyboard.type(typed);
  await page.waitForTimeout(2000); // the server gets the text
  await page.keyboard.press("Control+Space");
  const offered = await labels(page, ".suggest-widget.visible .monaco-list-row");
  await page.screenshot({ path: picture });
  const tokens = await page.$$eval(".view-line > span > span", (spans) => spans.map((span) => span.textContent));
  return { language, problems: shown, offered, tokens };
}

chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] }).then(async (browser) => {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
  try {
    console.log(JSON.stringify(await look(page)));
  } catch (error) {
    await page.screenshot({ path: picture });
    console.error(String(error));
    process.exitCode = 1;
  }
  await browser.close();
});
