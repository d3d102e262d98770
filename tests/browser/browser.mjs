// A headless Chromium without network, drawing WebGL in software.
import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';

export const chromiumPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);

export function launch() {
  return chromium.launch({
    executablePath: chromiumPath,
    args: ['--no-sandbox', '--no-first-run', '--disable-quic', '--disable-background-networking', '--disable-component-update',
      '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
  });
}

export const pageOf = (folder) => `file://${folder.split('/').map(encodeURIComponent).join('/')}/index.html`;

/// Opens a reaction in the player, stopped at a time, and waits until it is drawn.
export async function showAt(page, id, time) {
  await page.evaluate((wanted) => {
    const { page: review } = globalThis.ukemi;
    return review.open(review.reactions.find((one) => `${one.character}/${one.name}` === wanted));
  }, id);
  await seek(page, time);
}

export async function seek(page, time) {
  await page.evaluate((t) => globalThis.ukemi.page.player.seek(t, true), time);
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}
