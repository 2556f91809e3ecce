//! The layering and the house rules, checked.

mod architecture;
mod modules;
mod pages;
