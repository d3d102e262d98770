// screenshot.mjs FOLDER ID SECONDS OUT.png [OTHER_ID]: a reviewed folder's player with its ranges of motion, beside a
// pinned one where OTHER_ID is given; with ID "" all reactions.
import { launch, pageOf, seek, showAt } from './browser.mjs';

const [folder, id, seconds, out, other] = process.argv.slice(2);
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1440, height: 900 }, reducedMotion: 'reduce' });
await page.goto(pageOf(folder));
await page.waitForSelector('.card img');
if (id) {
  if (other) {
    await showAt(page, other, Number(seconds));
    await page.evaluate(() => globalThis.ukemi.page.player.togglePin());
  }
  await showAt(page, id, Number(seconds));
  await page.keyboard.press('o');
  await seek(page, Number(seconds));
} else {
  await page.waitForFunction(() => [...document.querySelectorAll('.card img.light')].slice(0, 10).every((image) => image.complete));
}
await page.waitForTimeout(400);
await page.screenshot({ path: out });
await browser.close();
