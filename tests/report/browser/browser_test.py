#!/usr/bin/python3
"""Opens report.html in a browser without a screen and checks what only a browser can show.

browser_test.py example PROGRAM             the page that PROGRAM FOLDER SAMPLES writes
browser_test.py diagnosis VIBRISSA LATE_RIG the page of a diagnosis of the records that LATE_RIG writes
Exit status 77 (skipped): no browser.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
BROWSER, DRIVER = "/usr/bin/chromium", "/usr/bin/chromedriver"
DARK = [{"name": "prefers-color-scheme", "value": "dark"}]
STILL = [{"name": "prefers-reduced-motion", "value": "reduce"}]

CONTRAST = """
const canvas = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
canvas.canvas.width = canvas.canvas.height = 1;
function rgba(text) {
  canvas.clearRect(0, 0, 1, 1); canvas.fillStyle = text; canvas.fillRect(0, 0, 1, 1);
  return canvas.getImageData(0, 0, 1, 1).data;
}
function light(c) {
  const [r, g, b] = [0, 1, 2].map((i) => c[i] / 255).map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
function behind(e) {
  for (; e; e = e.parentElement) {
    const c = rgba(getComputedStyle(e).backgroundColor);
    if (c[3] === 255) return c;
  }
  return [255, 255, 255, 255];
}
const poor = [];
let n = 0;
for (const d of document.querySelectorAll("details")) d.open = true;
const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (walk.nextNode()) {
  const e = walk.currentNode.parentElement;
  if (!walk.currentNode.data.trim() || ["SCRIPT", "STYLE", "NOSCRIPT", "OPTION"].includes(e.tagName) || !e.getClientRects().length) continue;
  const a = light(rgba(getComputedStyle(e).color)), b = light(behind(e));
  const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  ++n;
  if (ratio < 4.5) poor.push([ratio.toFixed(2), e.tagName, walk.currentNode.data.trim().slice(0, 30)]);
}
for (const d of document.querySelectorAll("details")) d.open = false;
return [n, poor];
"""

PIXELS = """
return [...document.querySelectorAll(".plot")].map((plot) => {
  let drawn = 0;
  for (const canvas of plot.querySelectorAll("canvas")) {
    if (!canvas.width || !canvas.height) continue;
    const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];  // grid and axes are grey, curves are not
      drawn += data[i + 3] > 0 && Math.max(r, g, b) - Math.min(r, g, b) > 60;
    }
  }
  return drawn;
});
"""

SAVED = """
const done = arguments[arguments.length - 1], button = arguments[0];
const make = URL.createObjectURL, click = HTMLAnchorElement.prototype.click;
let blob = null, name = null;
URL.createObjectURL = (b) => { blob = b; return make.call(URL, b); };
HTMLAnchorElement.prototype.click = function () { name = this.download; };
button.click();
URL.createObjectURL = make;
HTMLAnchorElement.prototype.click = click;
blob.text().then((text) => done([name, text]));
"""


def skip(reason):
    print("skipped:", reason)
    sys.exit(SKIPPED)


try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    skip("the package python3-selenium is missing")


def browser(profile, *more):
    options = webdriver.ChromeOptions()
    options.binary_location = BROWSER
    for flag in ("--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
                 "--disable-dev-shm-usage", "--enable-unsafe-swiftshader", "--no-first-run",
                 "--window-size=1200,900", f"--user-data-dir={profile}", *more):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=webdriver.ChromeService(DRIVER) if hasattr(webdriver, "ChromeService")
                            else webdriver.chrome.service.Service(DRIVER), options=options)


class Page:
    """One page in one browser; each check raises AssertionError."""

    def __init__(self, driver, file):
        self.driver, self.file = driver, file
        driver.get("about:blank")
        driver.get_log("performance")  # the browser's own first page
        self.open()

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def media(self, features):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})

    def width(self, pixels):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": pixels, "height": 800, "deviceScaleFactor": 1, "mobile": pixels < 500})

    def open(self):
        self.driver.get(self.file.as_uri())
        for _ in range(600):
            ready = self.run("return document.documentElement.dataset.ready")
            if ready:
                self.ready_ms = int(ready)
                return
            time.sleep(0.05)
        raise AssertionError(f"never ready: {self.driver.get_log('browser')}")

    def asks_for_nothing_and_has_no_errors(self):
        errors = [line for line in self.driver.get_log("browser") if line["level"] == "SEVERE"]
        assert not errors, errors
        asked = set()
        for line in self.driver.get_log("performance"):
            message = json.loads(line["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                asked.add(message["params"]["request"]["url"])
        others = [url for url in asked if url != self.file.as_uri() and not url.startswith(("data:", "blob:"))]
        assert self.file.as_uri() in asked, "the log of requests is empty"
        assert not others, others

    def draws_every_plot(self):
        rows = self.run("return vibrissaReport.plots.map((p) => p.g ? p.g.numRows() : 0)")
        pixels = self.run(PIXELS)
        assert rows and min(rows) > 0, rows
        assert len(pixels) == len(rows) and min(pixels) > 20, pixels

    def ranges(self):
        return self.run("return vibrissaReport.plots.map((p) => p.g.xAxisRange())")

    def zooms_and_resets(self):
        before = self.ranges()
        figure = self.driver.find_element(By.CSS_SELECTOR, "figure[data-figure]")
        plot = figure.find_element(By.CSS_SELECTOR, ".plot")
        self.run("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", plot)

        def changed(what):
            now = self.ranges()[0]
            assert now[1] - now[0] < 0.9 * (before[0][1] - before[0][0]), (what, now)

        def reset(what):
            now = self.ranges()
            for a, b in zip(sum(now, []), sum(before, [])):
                assert abs(a - b) <= 1e-9 * max(1, abs(b)), (what, now, before)

        def press(label):
            self.run("arguments[0].click()", figure.find_element(By.CSS_SELECTOR, f"button[aria-label='{label}']"))

        press("Zoom in")
        changed("button")
        press("Move right")
        assert self.ranges()[0][0] > before[0][0]
        press("Show all")
        reset("button")
        self.run("arguments[0].focus()", plot)
        ActionChains(self.driver).send_keys("+").send_keys(Keys.ARROW_LEFT).perform()
        changed("keys")
        ActionChains(self.driver).send_keys("0").perform()
        reset("key")
        ActionChains(self.driver).move_to_element_with_offset(plot, 0, 0).click_and_hold().move_by_offset(150, 0).release().perform()
        changed("mouse")
        ActionChains(self.driver).move_to_element(plot).double_click().perform()
        reset("double click")

    def panels_of_one_axis_move_together(self):
        figure = self.driver.find_element(By.CSS_SELECTOR, "figure[data-figure='0']")
        self.run("arguments[0].click()", figure.find_element(By.CSS_SELECTOR, "button[aria-label='Zoom in']"))
        first, second = self.ranges()[:2]
        assert first == second, (first, second)
        self.run("arguments[0].click()", figure.find_element(By.CSS_SELECTOR, "button[aria-label='Show all']"))

    def saves_each_csv(self, n_figures):
        compared = 0
        for button in self.driver.find_elements(By.CSS_SELECTOR, "button[data-save]"):
            name, text = self.driver.execute_async_script(SAVED, button)
            assert text.count("\n") > 1 and name.endswith(".csv"), name
            file = self.file.parent / "figures" / name
            if button.get_attribute("data-save") == "figures" and file.exists():
                assert text.encode() == file.read_bytes(), f"{name} differs from the file"
                compared += 1
        assert compared >= n_figures, compared

    def has_contrast_in_both_themes(self):
        for theme in ("dark", "light"):
            self.run("if ((document.documentElement.dataset.theme || 'light') !== arguments[0]) document.getElementById('theme').click()", theme)
            n, poor = self.run(CONTRAST)
            assert n > 20 and not poor, (theme, poor)

    def changes_its_theme(self):
        look = "return [getComputedStyle(document.body).backgroundColor, document.getElementById('theme').getAttribute('aria-pressed'), vibrissaReport.plots[0].g.getOption('gridLineColor')]"
        light = self.run(look)
        self.run("scrollTo({top: 0, behavior: 'instant'})")
        self.driver.find_element(By.ID, "theme").click()
        dark = self.run(look)
        assert all(a != b for a, b in zip(light, dark)), (light, dark)
        self.driver.find_element(By.ID, "theme").click()
        assert self.run(look) == light
        self.run("delete document.documentElement.dataset.theme")
        self.media(DARK)
        assert self.run(look)[0] == dark[0], "the system's choice counts without a click"
        self.media([])

    def is_readable_by_those_who_do_not_see_it(self):
        assert self.run("return document.documentElement.lang") == "en"
        for tag in ("header", "main", "footer", "h1", "nav"):
            assert self.run("return document.querySelectorAll(arguments[0]).length", tag) == 1, tag
        levels = self.run("return [...document.querySelectorAll('h1, h2, h3, h4')].map((h) => Number(h.tagName[1]))")
        assert all(b <= a + 1 for a, b in zip(levels, levels[1:])), levels
        nameless = self.run("return [...document.querySelectorAll('button, select, input, .plot, canvas[tabindex], [role=region]')].filter((e) => e.getClientRects().length && !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels && e.labels.length)).map((e) => e.outerHTML)")
        assert not nameless, nameless
        ids = self.run("return [...document.querySelectorAll('[id]')].map((e) => e.id)")
        assert len(set(ids)) == len(ids), ids
        bare = self.run("return [...document.querySelectorAll('figure')].filter((f) => !f.querySelector('figcaption') || !f.querySelector('details').textContent.trim()).length")
        assert bare == 0, bare
        self.open()  # the focus is nowhere yet
        ActionChains(self.driver).send_keys(Keys.TAB).perform()
        focus = self.run("const s = getComputedStyle(document.activeElement); return [document.activeElement.className, s.outlineStyle, document.activeElement.getBoundingClientRect().left]")
        assert focus[0] == "skip" and focus[1] != "none" and focus[2] >= 0, focus
        ActionChains(self.driver).send_keys(Keys.ENTER).perform()
        assert self.run("return location.hash") == "#content"

    def needs_no_scrolling_to_the_side(self):
        self.width(360)
        self.open()
        wide = self.run("return [document.documentElement.scrollWidth, innerWidth]")
        assert wide == [360, 360], wide
        self.draws_every_plot()
        self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        self.open()

    def prints(self):
        paper = self.driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})["data"]
        assert len(paper) > 20000, len(paper)
        self.draws_every_plot()
        assert self.run("return vibrissaReport.plots.every((p) => !p.box.style.zoom)")

    def takes_names_as_text(self):
        assert self.run("return document.querySelectorAll('img[src=x]').length") == 0
        assert "</script><script>alert(\"x\")</script>" in self.driver.title, self.driver.title

    def turns_and_moves_the_solid(self):
        if not self.run("return vibrissaReport.views[0].works"):
            print("no WebGL in this browser: the view is not tested")
            return
        state = lambda: self.run("return vibrissaReport.views[0].state()")
        picture = lambda: self.run("return document.querySelector('.stage canvas').toDataURL()")
        assert state()["triangles"] > 100
        assert self.run("return getComputedStyle(document.querySelector('.still')).display") == "none"
        canvas = self.driver.find_element(By.CSS_SELECTOR, ".stage canvas")
        self.run("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", canvas)
        time.sleep(0.4)
        one, phase = picture(), state()["phase"]
        time.sleep(0.3)
        assert state()["playing"] and picture() != one and state()["phase"] != phase
        play = [b for b in self.driver.find_elements(By.CSS_SELECTOR, ".view button") if b.text == "Pause"][0]
        self.run("arguments[0].click()", play)
        time.sleep(0.1)
        one = picture()
        time.sleep(0.2)
        assert play.text == "Play" and picture() == one
        self.run("arguments[0].focus()", canvas)
        ActionChains(self.driver).send_keys(Keys.ARROW_LEFT).perform()
        turned = picture()
        assert turned != one
        ActionChains(self.driver).move_to_element(canvas).click_and_hold().move_by_offset(40, 20).release().perform()
        assert picture() != turned
        one = picture()
        self.run("const s = document.querySelector('.view select'); s.value = '1'; s.dispatchEvent(new Event('change'))")
        assert state()["shown"] == 1 and picture() != one
        bar = self.driver.find_element(By.CSS_SELECTOR, ".bar").text
        assert "Stress [kPa]" in bar and "-6" in bar, bar
        lines = self.run("return vibrissaReport.csvOf('views', 0).text.split('\\n')")
        assert lines[0] == "x,y,z,ux,uy,uz,Stress [kPa]", lines[0]
        assert len(lines) == 3 * state()["triangles"] + 2 and all(len(l.split(",")) == 7 for l in lines[:-1])
        self.media(STILL)
        self.open()
        assert not self.run("return vibrissaReport.views[0].state().playing")
        self.media([])
        self.open()


def check(page, n_figures):
    page.asks_for_nothing_and_has_no_errors()
    page.draws_every_plot()
    page.zooms_and_resets()
    page.saves_each_csv(n_figures)
    page.changes_its_theme()
    page.has_contrast_in_both_themes()
    page.is_readable_by_those_who_do_not_see_it()
    page.prints()
    page.needs_no_scrolling_to_the_side()
    page.asks_for_nothing_and_has_no_errors()
    size = page.file.stat().st_size / 1e6
    print(f"{page.file.name}: {size:.2f} MB, all drawn {page.ready_ms} ms after the start of loading")


def check_example(program, work):
    subprocess.run([program, str(work), "20000"], check=True)
    file = work / "report.html"
    driver = browser(work / "profile")
    try:
        page = Page(driver, file)
        page.takes_names_as_text()
        check(page, 4)
        page.panels_of_one_axis_move_together()
        page.turns_and_moves_the_solid()
    finally:
        driver.quit()
    driver = browser(work / "profile_without_3d", "--disable-3d-apis")
    try:
        page = Page(driver, file)
        page.asks_for_nothing_and_has_no_errors()
        shown = page.run("return getComputedStyle(document.querySelector('.still')).display")
        assert shown != "none" and not page.run("return vibrissaReport.views[0].works")
    finally:
        driver.quit()


def check_diagnosis(vibrissa, late_rig, work):
    out = work / "diagnosis"
    subprocess.run([late_rig, str(work)], check=True)
    subprocess.run([vibrissa, "diagnose", "--quiet", "--max-effects", "1", "--sim", str(work / "sim"), "--real",
                    str(work / "real"), "-o", str(out)], check=True, stdout=subprocess.DEVNULL)
    driver = browser(work / "profile")
    try:
        check(Page(driver, out / "report.html"), 3)
    finally:
        driver.quit()


def main():
    for program in (BROWSER, DRIVER):
        if not shutil.which(program):
            skip(f"{program} is missing")
    with tempfile.TemporaryDirectory(prefix="vibrissa_browser_", ignore_cleanup_errors=True) as folder:
        work = pathlib.Path(folder).resolve()
        if sys.argv[1] == "example":
            check_example(sys.argv[2], work)
        else:
            check_diagnosis(sys.argv[2], sys.argv[3], work)


main()
