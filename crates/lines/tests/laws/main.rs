//! Laws of lines, exponents, ridges and contours.

mod contours;
mod known_exponents;
mod known_lines;
mod major_axis;
mod oblong_cells;
mod ridge_lines;
mod ridge_surfaces;
