//! Analyses and losses of the case that is made of a deck.

use super::*;
use crate::format::{Format, read_bytes};

/// Two bricks, the one on the other, with what else stands in the file.
fn case(rest: &str) -> Converted {
    let mut text = "*NODE, NSET=ALL\n".to_string();
    for (k, z) in [0.0, 1.0, 1.0, 2.0].into_iter().enumerate() {
        for (n, [x, y]) in [[0, 0], [1, 0], [1, 1], [0, 1]].into_iter().enumerate() {
            text += &format!("{}, {x}, {y}, {z}\n", 4 * k + n + 1);
        }
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=LOW\n1, 1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=C3D8, ELSET=HIGH\n2, 9,10,11,12,13,14,15,16\n\
             *MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.8E-9\n\
             *SOLID SECTION, ELSET=LOW, MATERIAL=STEEL\n*SOLID SECTION, ELSET=HIGH, MATERIAL=STEEL\n\
             *SURFACE, NAME=TOP\n1, S2\n*SURFACE, NAME=UNDER\n2, S1\n";
    let deck = read_bytes("a.inp", (text + rest).as_bytes(), Format::Abaqus);
    let deck = deck.unwrap_or_else(|error| panic!("{error}"));
    convert(&deck, Units::named("mm").unwrap()).unwrap_or_else(|error| panic!("{error}"))
}

const CONTACT: &str = "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.4\n** Interaction: rub\n*CONTACT PAIR, INTERACTION=I\nUNDER, TOP\n";

/// Number of modes and band of *FREQUENCY, each there or not, with and without a contact: what is no key is a comment and in the ledger.
#[test]
fn the_number_of_modes_and_the_band_of_a_file_are_kept() {
    for count in ["", "12"] {
        for low in ["", "50."] {
            for top in ["", "9000."] {
                for contact in ["", CONTACT] {
                    let step = format!("*STEP\n*FREQUENCY\n{count}, {low}, {top}\n*END STEP\n");
                    let made = case(&format!("{contact}{step}"));
                    let modes = made.case.split("[modes.imported]").nth(1).unwrap();
                    let (key, value) = match (count, top) {
                        ("", "") => ("count", "10"),
                        ("", _) => ("below", "\"9000 Hz\""),
                        _ => ("count", "12"),
                    };
                    assert!(modes.contains(&format!("{key} = {value}\n")), "{}", made.case);
                    let dropped = !low.is_empty() || !count.is_empty() && !top.is_empty();
                    for (word, f) in [("from 50", low), ("to 9000", top)] {
                        let said = dropped && !f.is_empty();
                        assert_eq!(
                            [&made.case, &made.page].map(|text| text.contains(word)),
                            [said; 2],
                            "{step}"
                        );
                    }
                    let lowest = if low.is_empty() { "0" } else { "50" };
                    let highest = if top.is_empty() { "10000" } else { "9000" };
                    let cea = format!("[cea]\nband = [{lowest}, {highest}]\n");
                    assert_eq!(made.case.contains(&cea), !contact.is_empty(), "{}", made.case);
                    let asked = made.case.contains("asks for 12 modes")
                        && made.page.contains("12 modes are asked for");
                    assert_eq!(asked, !contact.is_empty() && !count.is_empty(), "{}", made.case);
                }
            }
        }
    }
}

/// The band of the complex modes comes before that of the real ones.
#[test]
fn complex_modes_have_their_own_band_if_they_say_one() {
    let real = "*STEP\n*FREQUENCY\n, 20., 5000.\n*END STEP\n";
    for (data, band) in [("30\n", "[20, 5000]"), (", 100., 7000.\n", "[100, 7000]"), ("", "[20, 5000]")] {
        let made = case(&format!("{CONTACT}{real}*STEP\n*COMPLEX FREQUENCY\n{data}*END STEP\n"));
        assert!(made.case.contains(&format!("band = {band}\n")), "{}", made.case);
    }
}

/// What the file says that it lost: at the contact, else above all.
#[test]
fn losses_that_a_file_names_are_comments_of_the_case() {
    let comments = "** Not written: contact.rub: a load of 50 N is not written\n** Not written: springs: two are slanted\n";
    let made = case(&format!("{comments}{CONTACT}"));
    let contact = made.case.split("\n\n").find(|table| table.contains("[contact.rub]")).unwrap();
    assert!(contact.contains("# Lost before it came here: a load of 50 N is not written."), "{}", made.case);
    let head = made.case.split("[mesh]").next().unwrap();
    assert!(head.contains("# Lost before it came here: springs: two are slanted."), "{}", made.case);
    for words in ["contact.rub", "springs"] {
        let rows = || made.ledger.rows().filter(|row| row.weight == Weight::Matters);
        assert!(rows().any(|row| row.what == words), "{}", made.page);
    }
}
