//! Pictures as values: nested raster layers, paths and text.
//!
//! A scene is measured in pixels ([`Page`]). Drawing functions return one, exporters read it.

use crate::colour::Rgba;
use euclid::{Point2D, Vector2D};

/// Frame of a picture: pixels from its upper left corner, x to the right, y **downwards**.
#[derive(Debug, Clone, Copy)]
pub enum Page {}

/// A position in a picture. Two numbers make one (`[x, y].into()`), a point in cells does not.
pub type PagePoint = Point2D<f64, Page>;

/// A displacement in a picture.
pub type PageVector = Vector2D<f64, Page>;

/// Points (1/72 inch) per pixel of a page, unless a picture says otherwise: 96 pixels an inch.
pub(crate) const PT_PER_PX: f64 = 0.75;

/// A picture before it is exported.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Width in pixels.
    pub width_px: f64,
    /// Height in pixels.
    pub height_px: f64,
    /// Size of a pixel on paper, points (1/72 inch).
    pub pt_per_px: f64,
    /// Whether an SVG states its size in millimetres: that somebody asked for a size on paper.
    pub on_paper: bool,
    /// Short name, the accessible title of an SVG.
    pub title: String,
    /// A description of the picture in words, for readers who cannot see it.
    pub description: String,
    /// Parts, painted in this order on white.
    pub items: Vec<Item>,
}

/// One part of a scene.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// Coloured cells.
    Raster(Raster),
    /// Outline or area.
    Path(Path),
    /// A line of text.
    Text(Text),
    /// Other items, scaled and then moved.
    Group {
        /// Shift to the right in pixels.
        dx_px: f64,
        /// Shift downwards in pixels.
        dy_px: f64,
        /// Enlargement of the items.
        scale: f64,
        /// The items.
        items: Vec<Item>,
    },
}

/// A rectangle of coloured cells, stretched with nearest neighbour so that cells stay sharp.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    /// Left edge in pixels.
    pub x_px: f64,
    /// Upper edge in pixels.
    pub y_px: f64,
    /// Width and height of one cell in pixels; whole numbers keep cells equally large.
    pub cell_px: [f64; 2],
    /// Cells per row, at least 1.
    pub columns: usize,
    /// Colours row by row, the upper row first.
    pub cells: Vec<Rgba>,
}

impl Raster {
    /// Number of complete rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.cells.len().checked_div(self.columns).unwrap_or(0)
    }
}

/// One step of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Segment {
    /// Begins a sub-path.
    Move(PagePoint),
    /// Straight to a point.
    Line(PagePoint),
    /// Quadratic curve: control point, end.
    Quad(PagePoint, PagePoint),
    /// Cubic curve: two control points, end.
    Cubic(PagePoint, PagePoint, PagePoint),
    /// Back to the beginning of the sub-path.
    Close,
}

/// How a line is drawn. Ends and corners are round.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// Colour with opacity.
    pub colour: Rgba,
    /// Width in pixels.
    pub width_px: f64,
    /// Lengths of dashes and gaps in pixels; empty for a solid line.
    pub dash_px: Vec<f64>,
}

/// A path with its paint.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Steps.
    pub segments: Vec<Segment>,
    /// Colour of the inside (non-zero rule).
    pub fill: Option<Rgba>,
    /// Line.
    pub stroke: Option<Stroke>,
}

/// Which point of a text its position names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

/// A line of text on a baseline.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    /// Anchor point in pixels.
    pub x_px: f64,
    /// Baseline in pixels.
    pub y_px: f64,
    /// The text; characters the font lacks become boxes.
    pub text: String,
    /// Font size in pixels.
    pub size_px: f64,
    /// Colour.
    pub colour: Rgba,
    /// Meaning of the anchor point.
    pub anchor: Anchor,
    /// Counter-clockwise rotation about the anchor point, degrees.
    pub rotation_deg: f64,
}

impl Scene {
    /// Longest side of a PNG in pixels.
    pub const MAX_SIDE_PX: u32 = 8192;

    /// An empty scene.
    #[must_use]
    pub fn sized(width_px: f64, height_px: f64) -> Self {
        Self {
            width_px,
            height_px,
            pt_per_px: PT_PER_PX,
            on_paper: false,
            title: String::new(),
            description: String::new(),
            items: Vec::new(),
        }
    }

    /// Inserts the items of another scene, scaled by `scale`, with its upper left corner at (x, y) pixels.
    pub fn place(&mut self, scene: Self, x_px: f64, y_px: f64, scale: f64) {
        self.items.push(Item::Group { dx_px: x_px, dy_px: y_px, scale, items: scene.items });
    }

    pub(crate) fn fill(&mut self, segments: Vec<Segment>, colour: Rgba) {
        self.items.push(Item::Path(Path { segments, fill: Some(colour), stroke: None }));
    }

    pub(crate) fn stroke(&mut self, segments: Vec<Segment>, colour: Rgba, width_px: f64) {
        let stroke = Some(Stroke { colour, width_px, dash_px: Vec::new() });
        self.items.push(Item::Path(Path { segments, fill: None, stroke }));
    }

    pub(crate) fn paint(&mut self, segments: Vec<Segment>, fill: Rgba, line: Rgba, width_px: f64) {
        let stroke = Some(Stroke { colour: line, width_px, dash_px: Vec::new() });
        self.items.push(Item::Path(Path { segments, fill: Some(fill), stroke }));
    }

    pub(crate) fn text(
        &mut self,
        at: impl Into<PagePoint>,
        text: &str,
        size_px: f64,
        colour: Rgba,
        anchor: Anchor,
    ) {
        self.rotated_text(at, text, size_px, colour, anchor, 0.0);
    }

    pub(crate) fn rotated_text(
        &mut self,
        at: impl Into<PagePoint>,
        text: &str,
        size_px: f64,
        colour: Rgba,
        anchor: Anchor,
        rotation_deg: f64,
    ) {
        let PagePoint { x: x_px, y: y_px, .. } = at.into();
        if !text.is_empty() {
            let text = text.to_owned();
            self.items.push(Item::Text(Text { x_px, y_px, text, size_px, colour, anchor, rotation_deg }));
        }
    }
}

/// Collects the steps of a path.
#[derive(Debug, Clone, Default)]
pub struct PathBuilder(Vec<Segment>);

impl PathBuilder {
    /// Begins a sub-path at `p`.
    pub fn move_to(&mut self, p: impl Into<PagePoint>) {
        self.0.push(Segment::Move(p.into()));
    }
    /// A straight line to `p`.
    pub fn line_to(&mut self, p: impl Into<PagePoint>) {
        self.0.push(Segment::Line(p.into()));
    }
    /// A quadratic curve with control point `c` to `p`.
    pub fn quad_to(&mut self, c: PagePoint, p: PagePoint) {
        self.0.push(Segment::Quad(c, p));
    }
    /// A cubic curve with control points `c` and `d` to `p`.
    pub fn cubic_to(&mut self, c: PagePoint, d: PagePoint, p: PagePoint) {
        self.0.push(Segment::Cubic(c, d, p));
    }
    /// Closes the sub-path.
    pub fn close(&mut self) {
        self.0.push(Segment::Close);
    }
    /// Whether the path has no steps.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
    /// The steps.
    #[must_use]
    pub fn finish(self) -> Vec<Segment> {
        self.0
    }

    /// A rectangle.
    pub fn rect(&mut self, x: f64, y: f64, width: f64, height: f64) {
        self.polyline(&[[x, y], [x + width, y], [x + width, y + height], [x, y + height]], true);
    }

    /// A line from `a` to `b`.
    pub fn line(&mut self, a: impl Into<PagePoint>, b: impl Into<PagePoint>) {
        self.move_to(a);
        self.line_to(b);
    }

    /// Straight lines through `points`.
    pub fn polyline(&mut self, points: &[impl Into<PagePoint> + Copy], closed: bool) {
        for (i, p) in points.iter().enumerate() {
            if i == 0 { self.move_to(*p) } else { self.line_to(*p) }
        }
        if closed && !points.is_empty() {
            self.close();
        }
    }

    /// An ellipse about `centre` with conjugate semi-axes `a` and `b`.
    pub fn ellipse(&mut self, centre: PagePoint, a: PageVector, b: PageVector) {
        // Four cubics are within 0.03 % of a circle with this distance of the control points.
        const K: f64 = 0.552_284_749_830_793_4;
        let at = |u: f64, v: f64| centre + a * u + b * v;
        self.move_to(at(1.0, 0.0));
        self.cubic_to(at(1.0, K), at(K, 1.0), at(0.0, 1.0));
        self.cubic_to(at(-K, 1.0), at(-1.0, K), at(-1.0, 0.0));
        self.cubic_to(at(-1.0, -K), at(-K, -1.0), at(0.0, -1.0));
        self.cubic_to(at(K, -1.0), at(1.0, -K), at(1.0, 0.0));
        self.close();
    }

    /// A circle.
    pub fn circle(&mut self, centre: impl Into<PagePoint>, radius: f64) {
        self.ellipse(centre.into(), PageVector::new(radius, 0.0), PageVector::new(0.0, radius));
    }
}
