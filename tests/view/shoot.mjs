// Makes a picture of a whole page: shoot.mjs NODE-FOLDER BROWSER FOLDER PAGE OUT.png
import {launch} from './browser.mjs';

const [page, out] = process.argv.slice(5);
const browser = await launch();
const tab = await browser.newPage({viewport: {width: 2410, height: 800}});
await tab.goto('file://' + encodeURI(page));
await tab.screenshot({path: out, fullPage: true});
await browser.close();
