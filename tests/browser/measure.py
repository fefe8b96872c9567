"""Measures a page in Chromium: measure.py CHROMIUM PAGE WHAT; prints JSON. Playwright drives the browser."""

import json, sys
from playwright.sync_api import sync_playwright

FLAGS = """--no-sandbox --disable-quic --no-first-run --disable-background-networking --disable-component-update
           --disable-sync --use-angle=swiftshader --enable-unsafe-swiftshader --autoplay-policy=no-user-gesture-required"""

# What is wrong with the page as it is shown: a list of words each.
FAULTS = """() => {
    const faults = { tables: [], figures: [], contrast: [], wide: [] };
    const name = e => e.tagName + ' ' + (e.textContent || '').trim().slice(0, 40);
    const width = document.documentElement.clientWidth;
    // A table stands within its container, or that can be scrolled, which paper cannot.
    const paper = matchMedia('print').matches;
    for (const table of document.querySelectorAll('table')) {
        if (!table.checkVisibility()) continue;
        const box = table.parentElement, scrolls = ['auto', 'scroll'].includes(getComputedStyle(box).overflowX);
        if (table.scrollWidth > box.clientWidth + 1 && (paper || !scrolls)) faults.tables.push(name(table));
    }
    for (const figure of document.querySelectorAll('figure svg, figure canvas, figure audio')) {
        const box = figure.getBoundingClientRect();
        if (!figure.checkVisibility()) continue;
        if (!(box.width > 20 && box.height > 20)) faults.figures.push(name(figure));
        // A picture stays legible on a narrow screen, where its frame scrolls; paper cannot.
        const frame = (!paper && figure.closest('.picture') || figure).getBoundingClientRect();
        if (frame.left < -1 || frame.right > width + 1) faults.figures.push('past the edge: ' + name(figure));
    }
    // A narrow window shows charts whole; their words are as high as 9 px at least and do not lie on each other.
    const charts = [...document.querySelectorAll('figure svg:not(.whole)')].filter(svg => svg.querySelector('rect.axes') && svg.checkVisibility());
    if (!paper && width < 640 && charts.length && !charts.some(svg => svg.matches('.slim'))) faults.figures.push('no chart fits');
    for (const svg of charts.filter(svg => svg.matches('.slim'))) {
        const box = svg.getBoundingClientRect(), words = [...svg.querySelectorAll('text')].filter(e => e.checkVisibility({ visibilityProperty: true }));
        if (paper || width >= 640 || box.right > width + 1) faults.figures.push('does not fit: ' + name(svg));
        const boxes = words.map(e => e.getBoundingClientRect()), turned = e => (e.getAttribute('transform') || '').includes('rotate');
        boxes.forEach((a, k) => {
            if (Math.max(a.height, a.width) < 5 || (!turned(words[k]) && a.height < 9)) faults.figures.push('small: ' + name(words[k]));
            if (a.left < box.left - 1 && a.width < box.width) faults.figures.push('cut: ' + name(words[k]));
            const covers = (b, j) => j < k && !turned(words[k]) && !turned(words[j]) && a.left + 1 < b.right && b.left + 1 < a.right && a.top + 4 < b.bottom && b.top + 4 < a.bottom;
            if (boxes.some(covers)) faults.figures.push('covered: ' + name(words[k]));
        });
    }
    if (document.documentElement.scrollWidth > width + 1) {
        for (const e of document.body.querySelectorAll('*')) {
            if (e.getBoundingClientRect().right > width + 1 && !e.closest('svg') && !e.closest('.scroll, pre')) faults.wide.push(name(e));
        }
    }
    const sheet = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
    const colour = (css, under) => {
        sheet.fillStyle = `rgb(${under})`;
        sheet.fillRect(0, 0, 1, 1);
        sheet.fillStyle = css;
        sheet.fillRect(0, 0, 1, 1);
        return [...sheet.getImageData(0, 0, 1, 1).data].slice(0, 3);
    };
    const ground = e => {
        if (!e) return matchMedia('(prefers-color-scheme: dark)').matches && getComputedStyle(document.documentElement).colorScheme.includes('dark') ? [18, 18, 18] : [255, 255, 255];
        return colour(getComputedStyle(e).backgroundColor, ground(e.parentElement));
    };
    // WCAG 2.2: relative luminance and contrast ratio.
    const luminance = rgb => rgb.map(v => v / 255).map(v => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
        .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
    const ratio = (a, b) => {
        const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
        return (high + 0.05) / (low + 0.05);
    };
    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
        const e = texts.currentNode.parentElement;
        if (!texts.currentNode.textContent.trim() || e.closest('script, style, noscript, select, title, canvas') || !e.checkVisibility()) continue;
        const svg = e.closest('svg');
        // Pictures are drawn on white sheets.
        const under = svg ? [255, 255, 255] : ground(e);
        const ink = colour(svg ? getComputedStyle(e).fill : getComputedStyle(e).color, under);
        const found = ratio(ink, under);
        if (found < 4.5) faults.contrast.push(`${found.toFixed(2)}: ${name(e)}`);
    }
    return faults;
}"""

# The picture of the viewer, as a number per pixel that changes with it.
FRAME = "() => document.querySelector('#shapes canvas').toDataURL()"
COLOURS = """async () => {
    const canvas = document.querySelector('#shapes canvas'), copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
    copy.drawImage(canvas, 0, 0);
    const data = copy.getImageData(0, 0, canvas.width, canvas.height).data, seen = new Set();
    for (let k = 0; k < data.length; k += 4) if (data[k + 3]) seen.add(data[k] << 16 | data[k + 1] << 8 | data[k + 2]);
    return seen.size;
}"""


def opened(browser, page_file, log, **options):
    page = browser.new_context(**options).new_page()
    page.on("console", lambda message: log.append(message.text))
    page.on("pageerror", lambda error: log.append(str(error)))
    page.on("request", lambda request: request.url.startswith(("file:", "data:", "blob:")) or log.append("fetches " + request.url))
    page.goto("file://" + page_file)
    page.wait_for_timeout(300)
    return page


def screens(browser, page_file):
    found = {}
    for width in (1400, 390):
        for scheme in ("light", "dark"):
            log = []
            page = opened(browser, page_file, log, viewport={"width": width, "height": 900}, color_scheme=scheme)
            page.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
            found[f"{width} {scheme}"] = {**page.evaluate(FAULTS), "log": log}
    return found


def paper(browser, page_file):
    found = {}
    # Width of the sheet less margins of 1 cm, in CSS pixels.
    for sheet, width in (("A4", 718), ("Letter", 740)):
        log = []
        page = opened(browser, page_file, log, viewport={"width": width, "height": 1000}, color_scheme="light")
        pdf = page.pdf(format=sheet, print_background=True, margin=dict.fromkeys(("top", "bottom", "left", "right"), "1cm"))
        page.emulate_media(media="print")
        faults = page.evaluate(FAULTS)
        found[sheet] = {**faults, "log": log}
        assert pdf.startswith(b"%PDF") and len(pdf) > 10_000
    return found


def motion(browser, page_file):
    log = []
    page = opened(browser, page_file, log, viewport={"width": 1000, "height": 900})
    canvas = page.locator("#shapes canvas")
    canvas.scroll_into_view_if_needed()
    page.wait_for_timeout(300)
    frame = lambda wait=250: (page.wait_for_timeout(wait), page.evaluate(FRAME))[1]
    found = {"plays": frame() != frame(), "colours": page.evaluate(COLOURS)}
    page.click("#shapes [data-of=play]")
    rest = frame()
    found["pauses"] = rest == frame()
    changed = {}
    box = canvas.bounding_box()
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)

    def drag():
        page.mouse.move(*middle)
        page.mouse.down()
        page.mouse.move(middle[0] + 80, middle[1] + 30, steps=4)
        page.mouse.up()

    actions = {
        "drag": drag,
        "wheel": lambda: (canvas.focus(), page.mouse.wheel(0, -200)),
        "key": lambda: canvas.press("ArrowLeft"),
        "phase": lambda: page.fill("#shapes [data-of=phase]", "70"),
        "amplitude": lambda: page.fill("#shapes [data-of=amplitude]", "20"),
        "total": lambda: page.select_option("#shapes [data-of=colour]", "1"),
        "part": lambda: page.locator("#shapes [data-of=parts] input").first.click(),
        "mode": lambda: page.select_option("#shapes [data-of=mode]", index=0),
    }
    page.select_option("#shapes [data-of=mode]", index=page.locator("#shapes [data-of=mode] option").count() - 1)
    for name, act in actions.items():
        before = frame()
        act()
        changed[name] = frame() != before
    page.click("#shapes [data-of=home]")
    modes = page.locator("#shapes [data-of=mode] option").all_text_contents()
    return {**found, "changed": changed, "modes": modes, "log": log}


def in_time(browser, page_file):
    log = []
    page = opened(browser, page_file, log, viewport={"width": 1000, "height": 900})
    page.locator("#shapes canvas").scroll_into_view_if_needed()
    text = lambda name: page.locator(f"#shapes [data-of={name}]").evaluate("e => e.value")
    shown = page.locator("#shapes [data-of=mode] option:checked")
    found = {"set": shown.evaluate("e => e.parentElement.label"), "name": shown.text_content()}
    frames = []
    for phase in ("0", "90", "180"):
        page.fill("#shapes [data-of=phase]", phase)
        page.wait_for_timeout(250)
        frames.append([page.evaluate(FRAME), text("degrees")])
    found["differ"] = len({picture for picture, _ in frames}) == len(frames)
    found["times"] = [time for _, time in frames]
    page.click("#shapes [data-of=play]")
    page.wait_for_timeout(400)
    found["plays"] = text("degrees") != frames[-1][1]
    before = text("slower")
    page.fill("#shapes [data-of=speed]", "-2")
    page.wait_for_timeout(200)
    return {**found, "slower": [before, text("slower")], "log": log}


def still(browser, page_file):
    log = []
    page = opened(browser, page_file, log, viewport={"width": 1000, "height": 900})
    page.locator("#shapes canvas").scroll_into_view_if_needed()
    page.wait_for_timeout(700)
    note = page.locator("#shapes [data-of=note]").text_content()
    return {"note": note, "colours": page.evaluate(COLOURS), "log": log}


def sound(browser, page_file):
    log = []
    page = opened(browser, page_file, log)
    decode = """async () => {
        const audio = document.querySelector('audio');
        const data = Uint8Array.from(atob(audio.src.split(',')[1]), c => c.charCodeAt(0)).buffer;
        const buffer = await new OfflineAudioContext(1, 1, 48000).decodeAudioData(data);
        const samples = buffer.getChannelData(0);
        return { player: audio.duration, decoded: buffer.duration, peak: samples.reduce((m, v) => Math.max(m, Math.abs(v)), 0),
                 head: audio.src.slice(0, 4000) };
    }"""
    microphones = page.locator("figure:has(audio) option").all_text_contents()
    found = []
    for name in microphones:
        page.select_option("figure:has(audio) select", label=name)
        page.wait_for_timeout(300)
        decoded = page.evaluate(decode)
        # The farthest position that the player says, within ten seconds.
        decoded["position"] = page.locator("audio").evaluate("""audio => new Promise(resolve => {
            setTimeout(() => resolve(0), 10000);
            audio.addEventListener('timeupdate', () => audio.currentTime > 0 && resolve(audio.currentTime));
            audio.play();
        })""")
        found.append(decoded)
    return {"microphones": microphones, "found": found, "log": log}


def charts(browser, page_file):
    log = []
    page = opened(browser, page_file, log, viewport={"width": 1400, "height": 900})
    svg = page.locator("figure svg", has=page.locator("circle > title")).first
    svg.scroll_into_view_if_needed()
    rows = []
    for point in svg.locator("circle:has(> title)").all():
        box = point.bounding_box()
        page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        rows.append([point.text_content(), svg.locator("text").last.text_content()])
    view = lambda: svg.get_attribute("viewBox")
    home, box = view(), svg.bounding_box()
    page.mouse.move(box["x"] + 300, box["y"] + 100)
    page.mouse.down()
    page.mouse.move(box["x"] + 600, box["y"] + 250, steps=4)
    page.mouse.up()
    zoomed = view()
    page.mouse.dblclick(box["x"] + 300, box["y"] + 100)
    return {"points": rows, "home": home, "zoomed": zoomed, "reset": view(), "log": log}


chromium, page_file, what = sys.argv[1:]
flags = FLAGS.split() + (["--disable-3d-apis"] if what == "still" else [])
with sync_playwright() as playwright:
    browser = playwright.chromium.launch(executable_path=chromium, args=flags)
    print(json.dumps({"screens": screens, "paper": paper, "motion": motion, "in_time": in_time, "still": still, "sound": sound, "charts": charts}[what](browser, page_file)))
    browser.close()
