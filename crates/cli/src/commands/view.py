"""Shows a light transport gradient in ParaView: as a volume with a contour, and its middle slice beside it.

Run it with ParaView's option --script, or with pvpython. The third axis of the data is the direction in which
pulses are sent, from 0 to 360 degrees; it is at right angles to the plane of the field. Where the rows of the data run
downwards, everything is drawn with y mirrored.
"""

import os

from paraview.simple import *

here = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()
gradient = XMLImageDataReader(FileName=[os.path.join(here, "@VOLUME@")])
gradient.UpdatePipeline()
low, high = gradient.PointData["LTG"].GetRange()
# How the picture lies in the world: to the right, up, and along the directions.
right, up, normal = @RIGHT@, @UP@, @NORMAL@
mirrored = @MIRRORED@
bounds = gradient.GetDataInformation().GetBounds()
lengths = [bounds[2 * i + 1] - bounds[2 * i] for i in range(3)]
middle_point = [0.5 * (bounds[2 * i] + bounds[2 * i + 1]) for i in range(3)]
has_volume = gradient.GetDataInformation().GetExtent()[5] > 0
upright = [1.0, -1.0 if mirrored else 1.0, 1.0]
main = max(range(3), key=lambda i: abs(normal[i]))
if has_volume and abs(normal[main]) > 0.999:
    # The direction gets the length of the field, however many samples there are. Oblique planes cannot be stretched so.
    upright[main] = max(lengths[i] for i in range(3) if i != main) / lengths[main]

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
    middle.SliceType.Origin = middle_point
    middle.SliceType.Normal = normal
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
    for i, part in enumerate(("X", "Y", "Z")):
        setattr(deep.AxesGrid, part + "Title", "direction" if i == main else part.lower())
        setattr(deep.AxesGrid, part + "TitleColor", [0.0, 0.0, 0.0])
        setattr(deep.AxesGrid, part + "LabelColor", [0.0, 0.0, 0.0])
    AssignViewToLayout(view=deep, layout=layout)
    layout.SplitHorizontal(0, 0.5)
AssignViewToLayout(view=flat, layout=layout, hint=2 if has_volume else 0)

# Whatever is shown rescales the colours to itself.
colours.RescaleTransferFunction(low, high)
opacity = GetOpacityTransferFunction("LTG")
opacity.Points = [low, 0.0, 0.5, 0.0, low + 0.5 * (high - low), 0.02, 0.5, 0.0, high, 0.6, 0.5, 0.0]


def look(view, away):
    """Looks at the middle of the data from a point that far away along right, up and normal."""
    centre = [middle_point[i] * upright[i] for i in range(3)]
    view.CameraFocalPoint = centre
    view.CameraPosition = [centre[i] + away[0] * right[i] + away[1] * up[i] + away[2] * normal[i] for i in range(3)]


far = 1.7 * (max(lengths[i] for i in range(3) if i != main) or 1.0)
look(flat, (0.0, 0.0, far))
flat.CameraViewUp = up
ResetCamera(flat)
# Room for the colour bar.
flat.CameraParallelScale *= 1.6
if has_volume:
    look(deep, (far, -1.7 * far, far))
    deep.CameraViewUp = normal
RenderAllViews()
