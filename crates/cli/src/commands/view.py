"""Shows a light transport gradient in ParaView: as a volume with a contour, and its middle slice beside it.

Run it with ParaView's option --script, or with pvpython. The third axis of the data is the direction in which
pulses are sent, from 0 to 360 degrees. Rows run downwards in the data, so everything is drawn with y mirrored.
"""

import os

from paraview.simple import *

here = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()
gradient = XMLImageDataReader(FileName=[os.path.join(here, "@VOLUME@")])
gradient.UpdatePipeline()
low, high = gradient.PointData["LTG"].GetRange()
x0, x1, y0, y1, z0, z1 = gradient.GetDataInformation().GetBounds()
has_volume = z1 > z0
# The direction gets the length of the field, however many samples there are.
upright = [1.0, -1.0, max(x1 - x0, y1 - y0) / (z1 - z0) if has_volume else 1.0]

colours = GetColorTransferFunction("LTG")
colours.ApplyPreset("Viridis (matplotlib)", True)


def add(source, view, kind=None):
    """A source in a view, coloured by the gradient."""
    shown = Show(source, view)
    if kind:
        shown.SetRepresentationType(kind)
    ColorBy(shown, ("POINTS", "LTG"))
    shown.Scale = upright
    return shown


def plain(view):
    """A white view with the data's edges."""
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesLabelColor = [0.0, 0.0, 0.0]
    edges = Show(Outline(Input=gradient), view)
    edges.AmbientColor = edges.DiffuseColor = [0.3, 0.3, 0.3]
    edges.Scale = upright


layout = CreateLayout("Light transport gradient")
flat = CreateRenderView()
flat.InteractionMode = "2D"
plain(flat)
middle = gradient
if has_volume:
    middle = Slice(Input=gradient)
    middle.SliceType.Origin = [0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (z0 + z1)]
    middle.SliceType.Normal = [0.0, 0.0, 1.0]
    middle.Triangulatetheslice = 0
shown = add(middle, flat, "Surface")
shown.Ambient, shown.Diffuse = 1.0, 0.0
shown.SetScalarBarVisibility(flat, True)
bar = GetScalarBar(colours, flat)
bar.Title, bar.ComponentTitle = "LTG, middle slice" if has_volume else "LTG", ""
bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
bar.AutoOrient, bar.Orientation = 0, "Horizontal"
bar.WindowLocation = "Lower Center"
bar.ScalarBarLength = 0.6
bar.TitleFontSize, bar.LabelFontSize = 14, 12
bar.LabelFormat = bar.RangeLabelFormat = "%.4g"

if has_volume:
    deep = CreateRenderView()
    plain(deep)
    add(gradient, deep, "Volume")
    crest = Contour(Input=gradient, ContourBy=["POINTS", "LTG"], Isosurfaces=[low + 0.7 * (high - low)])
    add(crest, deep).Opacity = 0.3
    deep.AxesGrid.Visibility = 1
    deep.AxesGrid.XTitle, deep.AxesGrid.YTitle, deep.AxesGrid.ZTitle = "x", "y", "direction"
    for part in ("X", "Y", "Z"):
        setattr(deep.AxesGrid, part + "TitleColor", [0.0, 0.0, 0.0])
        setattr(deep.AxesGrid, part + "LabelColor", [0.0, 0.0, 0.0])
    AssignViewToLayout(view=deep, layout=layout)
    layout.SplitHorizontal(0, 0.5)
AssignViewToLayout(view=flat, layout=layout, hint=2 if has_volume else 0)

# Whatever is shown rescales the colours to itself.
colours.RescaleTransferFunction(low, high)
opacity = GetOpacityTransferFunction("LTG")
opacity.Points = [low, 0.0, 0.5, 0.0, low + 0.5 * (high - low), 0.02, 0.5, 0.0, high, 0.6, 0.5, 0.0]

ResetCamera(flat)
# Room for the colour bar.
flat.CameraParallelScale *= 1.6
if has_volume:
    x, y, z = ((a + b) * s / 2 for a, b, s in zip((x0, y0, z0), (x1, y1, z1), upright))
    deep.CameraFocalPoint = [x, y, z]
    far = 1.7 * max(x1 - x0, y1 - y0)
    deep.CameraPosition = [x + far, y - 1.7 * far, z + far]
    deep.CameraViewUp = [0.0, 0.0, 1.0]
RenderAllViews()
