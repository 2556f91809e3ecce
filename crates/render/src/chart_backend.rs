//! A drawing backend of plotters that fills a [`Scene`].
//!
//! plotters counts in whole units. Eight of them make a pixel here, so that lines are not bent to the pixel grid.

use crate::colour::Rgba;
use crate::font;
use crate::scene::{Anchor, PagePoint, PathBuilder, Scene};
use crate::shapes;
use core::convert::Infallible;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontTransform,
};
use std::cell::RefCell;
use std::rc::Rc;

/// Units of plotters per pixel.
pub(crate) const UNITS: i32 = 8;

/// The target of the backend, shared with the caller because plotters owns its backend and does not support dashes.
pub(crate) struct Canvas {
    pub(crate) scene: Scene,
    /// Dashes of the next lines.
    pub(crate) dash_px: Vec<f64>,
}

pub(crate) struct SceneBackend(pub(crate) Rc<RefCell<Canvas>>);

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

fn px((x, y): BackendCoord) -> PagePoint {
    PagePoint::new(f64::from(x) / f64::from(UNITS), f64::from(y) / f64::from(UNITS))
}

fn rgba(colour: BackendColor) -> Rgba {
    let (r, g, b) = colour.rgb;
    Rgba { r, g, b, a: 255 }.with_opacity(colour.alpha)
}

impl SceneBackend {
    fn stroke<S: BackendStyle>(&self, points: &[PagePoint], closed: bool, style: &S) {
        let mut path = PathBuilder::default();
        path.polyline(&shapes::simplified(points, 0.03), closed);
        let canvas = &mut *self.0.borrow_mut();
        let width = f64::from(style.stroke_width()) / f64::from(UNITS);
        let dash_px = canvas.dash_px.clone();
        shapes::dashed(&mut canvas.scene, path.finish(), rgba(style.color()), width, &dash_px);
    }

    fn fill(&self, path: PathBuilder, colour: BackendColor) {
        self.0.borrow_mut().scene.fill(path.finish(), rgba(colour));
    }
}

impl DrawingBackend for SceneBackend {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        let scene = &self.0.borrow().scene;
        let units = |px: f64| (px * f64::from(UNITS)).round() as u32;
        (units(scene.width_px), units(scene.height_px))
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, colour: BackendColor) -> Drawn {
        let PagePoint { x, y, .. } = px(point);
        let mut path = PathBuilder::default();
        path.rect(x, y, 1.0 / f64::from(UNITS), 1.0 / f64::from(UNITS));
        self.fill(path, colour);
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.stroke(&[px(from), px(to)], false, style);
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        upper_left: BackendCoord,
        bottom_right: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let (low, high) = (px(upper_left), px(bottom_right));
        if fill {
            let mut path = PathBuilder::default();
            path.rect(low.x, low.y, high.x - low.x, high.y - low.y);
            self.fill(path, style.color());
        } else {
            let corners = [low, PagePoint::new(high.x, low.y), high, PagePoint::new(low.x, high.y)];
            self.stroke(&corners, true, style);
        }
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let points: Vec<PagePoint> = path.into_iter().map(px).collect();
        if points.len() > 1 {
            self.stroke(&points, false, style);
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        center: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let mut path = PathBuilder::default();
        path.circle(px(center), f64::from(radius) / f64::from(UNITS));
        if fill {
            self.fill(path, style.color());
        } else {
            let width = f64::from(style.stroke_width()) / f64::from(UNITS);
            self.0.borrow_mut().scene.stroke(path.finish(), rgba(style.color()), width);
        }
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        vertices: I,
        style: &S,
    ) -> Drawn {
        let points: Vec<PagePoint> = vertices.into_iter().map(px).collect();
        let mut path = PathBuilder::default();
        path.polyline(&points, true);
        self.fill(path, style.color());
        Ok(())
    }

    fn draw_text<T: BackendTextStyle>(&mut self, text: &str, style: &T, position: BackendCoord) -> Drawn {
        let size = style.size() / f64::from(UNITS);
        let anchor = match style.anchor().h_pos {
            HPos::Left => Anchor::Start,
            HPos::Center => Anchor::Middle,
            HPos::Right => Anchor::End,
        };
        let drop = font::CAP_HEIGHT_EM
            * size
            * match style.anchor().v_pos {
                VPos::Top => 1.0,
                VPos::Center => 0.5,
                VPos::Bottom => 0.0,
            };
        let PagePoint { x, y, .. } = px(position);
        let (at, turned) = match style.transform() {
            FontTransform::None => ([x, y + drop], 0.0),
            FontTransform::Rotate90 => ([x - drop, y], -90.0),
            FontTransform::Rotate180 => ([x, y - drop], 180.0),
            FontTransform::Rotate270 => ([x + drop, y], 90.0),
        };
        self.0.borrow_mut().scene.rotated_text(at, text, size, rgba(style.color()), anchor, turned);
        Ok(())
    }

    fn estimate_text_size<T: BackendTextStyle>(
        &self,
        text: &str,
        style: &T,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let width = font::text_width(text, style.size());
        let height = font::CAP_HEIGHT_EM * style.size();
        Ok((width.ceil() as u32, height.ceil() as u32))
    }
}
