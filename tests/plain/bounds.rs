//! Every assertion that holds an error against a small bound does so by `bounds::within(error, bound, origin)`, which says where the
//! bound comes from and keeps a record of how much of it is used.
//!
//! Recognised by the text, in the condition of every `assert!` of the repository and in closures of one expression and private functions of
//! the file that such a condition calls: `a < b` and `a <= b` where b has a number with a negative exponent or an `EPSILON` in it, or where a ends with
//! `.abs()` or a norm; and `b > a`, `b >= a` with such a b. Statements of order (`growth > 1e-3`, `a < b`) are not of this kind.

use std::ops::Range;
use std::path::Path;

/// The text with comments, strings and characters blanked, each byte at its place.
fn code_of(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let mut code = bytes.to_vec();
    let mut at = 0;
    let until = |from: usize, end: &str| text[from..].find(end).map_or(bytes.len(), |k| from + k + end.len());
    while at < bytes.len() {
        let rest = &bytes[at..];
        let word = at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_');
        let hashes = rest[1..].iter().take_while(|c| **c == b'#').count();
        let end = if rest.starts_with(b"//") {
            until(at, "\n") - 1
        } else if rest.starts_with(b"/*") {
            until(at, "*/")
        } else if !word && rest[0] == b'r' && rest.get(1 + hashes) == Some(&b'"') {
            until(at + 2 + hashes, &format!("\"{}", "#".repeat(hashes)))
        } else if rest[0] == b'"' {
            let mut end = at + 1;
            while end < bytes.len() && bytes[end] != b'"' {
                end += if bytes[end] == b'\\' { 2 } else { 1 };
            }
            end + 1
        } else if rest[0] == b'\'' && rest.get(1) == Some(&b'\\') {
            until(at + 3, "'")
        } else if rest[0] == b'\'' && text[at + 1..].chars().nth(1) == Some('\'') {
            until(at + 1, "'")
        } else {
            at += 1;
            continue;
        };
        let end = end.clamp(at + 1, bytes.len());
        code[at..end].iter_mut().filter(|c| **c != b'\n').for_each(|c| *c = b' ');
        at = end;
    }
    code
}

/// Where the bracket at `open` closes.
fn closing(code: &[u8], open: usize) -> usize {
    let mut depth = 0;
    let step = |c: u8| i32::from(b"([{".contains(&c)) - i32::from(b")]}".contains(&c));
    let ends = code[open..].iter().position(|c| {
        depth += step(*c);
        depth == 0
    });
    ends.map_or(code.len(), |k| open + k)
}

/// The operands before and after the operator at `at`, inside `range`.
fn operands(code: &[u8], at: Range<usize>, range: &Range<usize>) -> [String; 2] {
    let (mut begin, mut end, mut depth) = (at.start, at.end, 0);
    while begin > range.start {
        let c = code[begin - 1];
        depth += i32::from(b")]}".contains(&c)) - i32::from(b"([{".contains(&c));
        let two = &code[begin.saturating_sub(2)..begin];
        if depth < 0 || depth == 0 && (b",;|".contains(&c) || [b"&&", b"=>", b" ="].iter().any(|t| two == *t))
        {
            break;
        }
        begin -= 1;
    }
    depth = 0;
    while end < range.end {
        let c = code[end];
        depth += i32::from(b"([{".contains(&c)) - i32::from(b")]}".contains(&c));
        if depth < 0
            || depth == 0 && (b",;|".contains(&c) || code[end..].starts_with(b"&&"))
            || c == b'{' && depth == 1
        {
            break;
        }
        end += 1;
    }
    [begin..at.start, at.end..end].map(|part| String::from_utf8_lossy(&code[part]).trim().to_string())
}

/// Whether an expression has a number with a negative exponent or an ε in it.
fn is_small(expression: &str) -> bool {
    let bytes = expression.as_bytes();
    let exponent = |k: usize| {
        let before =
            bytes[..k].iter().rposition(|c| !(c.is_ascii_digit() || b"._".contains(c))).map_or(0, |k| k + 1);
        let number = before < k && bytes[before].is_ascii_digit();
        let named = before > 0 && bytes[before - 1].is_ascii_alphabetic();
        number && !named && bytes.get(k + 2).is_some_and(u8::is_ascii_digit)
    };
    expression.contains("EPSILON") || expression.match_indices("e-").any(|(k, _)| exponent(k))
}

/// Whether an expression ends with an absolute value or a norm.
fn is_size(expression: &str) -> bool {
    let Some(inner) = expression.strip_suffix(')') else { return false };
    let mut depth = 1;
    let open = inner.bytes().rposition(|c| {
        depth += i32::from(c == b')') - i32::from(c == b'(');
        depth == 0
    });
    let before = open.map_or("", |open| &inner[..open]);
    let name = before.rsplit('.').next().unwrap_or_default();
    before.contains('.')
        && (name == "abs" || name == "norm" || name.starts_with("norm_") && name != "norm_sqr")
}

/// Comparisons with a small bound inside of a range.
fn comparisons(code: &[u8], range: Range<usize>) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for at in range.clone() {
        let blank = |k: usize| code.get(k).is_some_and(u8::is_ascii_whitespace);
        if !b"<>".contains(&code[at]) || at == 0 || !blank(at - 1) {
            continue;
        }
        let end = at + 1 + usize::from(code.get(at + 1) == Some(&b'='));
        if !blank(end) {
            continue;
        }
        let [left, right] = operands(code, at..end, &range);
        let less = code[at] == b'<';
        if less && (is_small(&right) || is_size(&left)) || !less && is_small(&left) {
            let sign = String::from_utf8_lossy(&code[at..end]).into_owned();
            let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
            found.push((at, format!("{} {sign} {}", words(&left), words(&right))));
        }
    }
    found
}

/// The first places of a word that is not a part of another one.
fn places(code: &[u8], word: &str) -> Vec<usize> {
    let part = |c: u8| c.is_ascii_alphanumeric() || c == b'_';
    let text = code.windows(word.len()).enumerate().filter(|(_, window)| *window == word.as_bytes());
    text.map(|(at, _)| at).filter(|at| *at == 0 || !part(code[at - 1])).collect()
}

/// Lines with an assertion that compares by hand, and the comparison.
fn by_hand(text: &str) -> Vec<(usize, String)> {
    let code = code_of(text);
    let starts = ["assert!(", "debug_assert!("].map(|word| (word, places(&code, word)));
    let conditions: Vec<Range<usize>> = starts
        .iter()
        .flat_map(|(word, at)| at.iter().map(|at| at + word.len()))
        .map(|begin| begin..closing(&code, begin - 1))
        .collect();
    let mut found: Vec<(usize, String)> =
        conditions.iter().flat_map(|range| comparisons(&code, range.clone())).collect();
    // Closures of one expression, up to their semicolon; private functions that answer yes or no.
    let name = |from: usize| -> String {
        code[from..]
            .iter()
            .take_while(|c| c.is_ascii_alphanumeric() || **c == b'_')
            .map(|c| char::from(*c))
            .collect()
    };
    let mut helpers = Vec::new();
    for at in places(&code, "let ") {
        let name = name(at + 4);
        let body = at + 4 + name.len();
        if !code[body..].starts_with(b" = |") {
            continue;
        }
        let opened = body + 4;
        let block =
            code[opened..].iter().position(|c| *c == b'|').map(|k| code[opened + k + 1..].trim_ascii_start());
        if block.is_none_or(|block| block.starts_with(b"{")) {
            continue;
        }
        let mut end = body;
        while end < code.len() && code[end] != b';' {
            end = if b"([{".contains(&code[end]) { closing(&code, end) + 1 } else { end + 1 };
        }
        helpers.push((name, body..end.min(code.len())));
    }
    for at in places(&code, "fn ") {
        let Some(open) = code[at..].iter().position(|c| *c == b'{').map(|k| at + k) else { continue };
        let public = code[..at].trim_ascii_end().ends_with(b"pub");
        if !public && code[at..open].trim_ascii_end().ends_with(b"-> bool") {
            helpers.push((name(at + 3), open..closing(&code, open)));
        }
    }
    for (name, body) in helpers {
        let called = |range: &Range<usize>| !places(&code[range.clone()], &format!("{name}(")).is_empty();
        if !name.is_empty() && conditions.iter().any(called) {
            found.extend(comparisons(&code, body));
        }
    }
    found.sort();
    found.dedup();
    found
        .into_iter()
        .map(|(at, words)| (1 + code[..at].iter().filter(|c| **c == b'\n').count(), words))
        .collect()
}

/// Paths of the sources below a folder.
fn sources(folder: &Path, all: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the repository").flatten() {
        let path = entry.path();
        if path.is_dir() && !path.ends_with("target") {
            sources(&path, all);
        } else if path.extension().is_some_and(|e| e == "rs") {
            all.push(path);
        }
    }
}

#[test]
fn assertions_hold_errors_against_bounds_of_a_named_origin() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = Vec::new();
    ["src", "crates", "tests", "examples", "benches", "fuzz", "python"]
        .iter()
        .for_each(|folder| sources(&root.join(folder), &mut all));
    all.sort();
    let mut faults = String::new();
    for path in &all {
        let text = std::fs::read_to_string(path).expect("source is text");
        for (line, comparison) in by_hand(&text) {
            let name = path.strip_prefix(root).expect("below the root").display();
            faults += &format!(
                "{name}:{line}: `{comparison}`: write `within(error, bound, …)` of `bounds`, with the origin of the bound\n"
            );
        }
    }
    assert!(faults.is_empty(), "{faults}");
    assert!(all.len() > 300, "{} files", all.len());
}

#[test]
fn comparisons_by_hand_are_recognised_and_statements_of_order_are_not() {
    let wraps = [
        "assert!(HERE);",
        "assert!(ready && HERE, \"{a} < {b}\");",
        "    assert!(\n        pairs.iter().zip(&others).all(|(a, b)| HERE),\n        \"words\"\n    );",
        "assert!(!wide || (HERE && n < 12), \"{}\", x.abs());",
        "debug_assert!(HERE);",
        "let near = |a: f64, b: f64| HERE;\nassert!(near(a, b));",
        "fn near(a: f64, b: f64) -> bool {\n    HERE\n}\nfn test() { assert!(both && near(a, b)); }",
    ];
    let bad = [
        "(a - b).abs() < 1e-9",
        "(a - b).abs() <= bound",
        "error < 1e-9 * size",
        "error <= 4.0 * f64::EPSILON",
        "(x - y).norm_l2() < 0.1",
        "1e-6 > worst",
        "2.5e-3 * scale >= *error",
        "off(&found, '<') < 3.0 + 1e-12",
    ];
    let good = [
        "a < b",
        "growth > 1e-3",
        "count < 12",
        "largest >= 1e-3 * size",
        "within((a - b).abs(), 1e-9, RoundOff)",
        "(1e-3..2e-3).contains(&x)",
        "x.abs() > 0.5",
        "name_1e - 3 < n",
        "text == \"x.abs() < 1e-9\"",
        "vector::<f64>(1e-9) < b // x.abs() < 1e-9\n",
        "a.norm_sqr() < b",
    ];
    for wrap in wraps {
        for (conditions, expected) in [(&bad[..], 1), (&good[..], 0)] {
            for condition in conditions {
                let text = wrap.replace("HERE", condition);
                assert_eq!(by_hand(&text).len(), expected, "{text}");
            }
        }
    }
    // Outside of assertions a distance may be measured by hand.
    for text in [
        "let k = all.iter().position(|b| (a - b).abs() < 1e-9);",
        "if error < 1e-9 { assert!(found); }",
        "let at = |x| { all.iter().position(|y| (x - y).abs() < 1e-9) };\nassert!(at(x).is_some());",
        "pub fn steady(&self) -> bool { self.drift.abs() < 1e-3 }\nfn test() { assert!(cycle.steady()); }",
    ] {
        assert!(by_hand(text).is_empty(), "{text}");
    }
    assert_eq!(by_hand("\n\nassert!(x < 1e-9);")[0], (3, "x < 1e-9".to_string()));
}
