//! Small decks, one for each form and concept.
