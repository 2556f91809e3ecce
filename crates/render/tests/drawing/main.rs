//! Colours, text and whole pictures.

mod colours_and_text;
mod pictures;
