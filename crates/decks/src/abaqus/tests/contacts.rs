//! Contact pairs and their laws.

use super::*;
use crate::deck::Contact;

const PAIR: &str = "*SURFACE, NAME=Pad\n1, S1\n*SURFACE, NAME=Disc\n2, S2\n*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nPad, Disc\n";

fn contact(law: &str) -> (Contact, Vec<Weight>) {
    let deck = bricks(&format!("{PAIR}*SURFACE INTERACTION, NAME=I\n1.,\n{law}"));
    (deck.contacts[0].clone(), notes(&deck).iter().map(|(weight, ..)| *weight).collect())
}

/// The law stands below the pair.
#[test]
fn pairs_have_the_friction_and_stiffness_of_their_interaction() {
    let (hard, listed) =
        contact("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n*FRICTION, SLIP TOLERANCE=0.005\n0.4,\n");
    assert_eq!((hard.slave.as_str(), hard.master.as_str(), hard.name.as_str()), ("Pad", "Disc", ""));
    assert_eq!(
        (hard.friction, hard.stiffness, hard.stick, hard.closed, listed),
        (0.4, None, None, false, vec![Weight::Perhaps])
    );
    // CalculiX: slope and the tension at infinity; μ and the slope before it slips.
    let (linear, listed) =
        contact("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e7, 3.\n*FRICTION\n0.3, 5e4\n");
    assert_eq!(
        (linear.friction, linear.stiffness, linear.stick, listed),
        (0.3, Some(1e7), Some(5e4), vec![])
    );
    let (table, listed) = contact("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n100., 0.5\n");
    assert_eq!((table.stiffness, listed), (Some(200.0), vec![]));
    let (curved, listed) = contact("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n1e-3, 2.\n");
    assert_eq!((curved.stiffness, listed), (None, vec![Weight::Matters]));
    let (curved, listed) =
        contact("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n1., 0.5\n9., 1.\n");
    assert_eq!((curved.stiffness, listed), (None, vec![Weight::Matters]));
    let (rough, listed) = contact("*FRICTION, ROUGH\n");
    assert_eq!((rough.friction, listed), (0.0, vec![Weight::Matters]));
    // The second number is a slip rate, or the kinetic coefficient.
    let (rates, listed) = contact("*FRICTION\n0.5, 0.\n0.3, 10.\n");
    assert_eq!((rates.friction, rates.stick, listed), (0.5, None, vec![Weight::Matters]));
    let (decay, listed) = contact("*FRICTION, EXPONENTIAL DECAY\n0.5, 0.3, 2.\n");
    assert_eq!((decay.friction, decay.stick, listed), (0.5, None, vec![Weight::Matters]));
}

/// The steps of a squeal analysis: friction begins with zero.
#[test]
fn friction_of_the_last_step_is_read() {
    let deck = bricks(&format!(
        "{PAIR}*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.\n*SURFACE INTERACTION, NAME=J\n*FRICTION\n0.1\n*STEP\n*CHANGE FRICTION, INTERACTION=I\n*FRICTION\n0.45\n*END STEP\n"
    ));
    assert_eq!(deck.contacts[0].friction, 0.45);
    assert_eq!(notes(&deck), [(Weight::Perhaps, "*CHANGEFRICTION", 30)]);
}

#[test]
fn tied_pairs_are_ties() {
    for text in [
        PAIR.replace("INTERACTION=I", "INTERACTION=I, TIED") + "*SURFACE INTERACTION, NAME=I\n",
        PAIR.replace("INTERACTION=I", "TIED"),
        format!("{PAIR}*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1e7\n"),
    ] {
        let deck = bricks(&text.replace("TYPE=", "ADJUST=0.1, TYPE="));
        assert_eq!((deck.contacts.len(), deck.ties.len()), (0, 1), "{text}");
        assert_eq!((deck.ties[0].slave.as_str(), deck.ties[0].within), ("Pad", Some(0.1)));
    }
    let closed =
        bricks(&format!("{}*SURFACE INTERACTION, NAME=I\n", PAIR.replace("TYPE=", "ADJUST=0., TYPE=")));
    assert!(closed.contacts[0].closed);
}

#[test]
fn contact_that_is_wrong_or_not_read_is_named() {
    fault(&format!("{BRICKS}{PAIR}"), 22, "INTERACTION=I");
    fault(
        &format!("{BRICKS}{}*SURFACE INTERACTION, NAME=I\n", PAIR.replace("Pad, Disc", "Pad, Rotor")),
        22,
        "`Rotor`",
    );
    fault(&format!("{BRICKS}{PAIR}*SURFACE INTERACTION, NAME=I\n*FRICTION\n"), 24, "without data");
    fault(
        &format!(
            "{BRICKS}{PAIR}*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n"
        ),
        24,
        "without a slope",
    );
    fault(&format!("{BRICKS}*CHANGE FRICTION, INTERACTION=K\n"), 17, "INTERACTION=K");
    let itself = bricks(&format!(
        "{}*SURFACE INTERACTION, NAME=I\n*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*FRICTION, NONE\n",
        PAIR.replace("Pad, Disc", "Pad,")
    ));
    assert!(itself.contacts.is_empty());
    assert_eq!(notes(&itself).iter().map(|(weight, ..)| *weight).collect::<Vec<_>>(), [Weight::Matters; 3]);
}

/// Options that change the model and are not read: each is listed with its reason, unless it is switched off.
#[test]
fn options_that_are_not_read_are_listed() {
    for words in super::super::keywords::unread_options() {
        let data = if words.starts_with("*FRICTION") { "0.4,\n" } else { "" };
        for (value, listed) in [("", true), ("=0.005", true), ("=YES", true), ("=NO", false)] {
            let deck = bricks(&format!("*SURFACE INTERACTION, NAME=I\n1.,\n{words}{value}\n{data}"));
            let row = deck.ledger.rows().find(|row| row.what == words);
            assert_eq!(row.is_some(), listed, "{words}{value}");
            assert!(row.is_none_or(|row| row.why != "an option that is not read"), "{words}");
        }
    }
}
