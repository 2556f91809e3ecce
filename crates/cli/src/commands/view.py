"""Opens a light transport gradient in ParaView as a volume, a contour and a slice.

Run it with ParaView's option --script, or with pvpython. The third axis of the data is the direction in which
pulses are sent, from 0 to 360 degrees; rows run downwards in the data, so the camera looks from behind.
"""

import os

from paraview.simple import *

here = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()
gradient = XMLImageDataReader(FileName=[os.path.join(here, "@VOLUME@")])
gradient.UpdatePipeline()
low, high = gradient.PointData["LTG"].GetRange()
x0, x1, y0, y1, z0, z1 = gradient.GetDataInformation().GetBounds()
view = GetActiveViewOrCreate("RenderView")

colours = GetColorTransferFunction("LTG")
colours.ApplyPreset("Viridis (matplotlib)", True)
colours.RescaleTransferFunction(low, high)
opacity = GetOpacityTransferFunction("LTG")
opacity.Points = [low, 0.0, 0.5, 0.0, low + 0.4 * (high - low), 0.05, 0.5, 0.0, high, 0.8, 0.5, 0.0]

if z1 > z0:
    volume = Show(gradient, view)
    volume.SetRepresentationType("Volume")
    ColorBy(volume, ("POINTS", "LTG"))

    ridges = Contour(Input=gradient, ContourBy=["POINTS", "LTG"], Isosurfaces=[low + 0.6 * (high - low)])
    ColorBy(Show(ridges, view), ("POINTS", "LTG"))

middle = Slice(Input=gradient)
middle.SliceType.Origin = [0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (z0 + z1)]
middle.SliceType.Normal = [0.0, 0.0, 1.0]
shown = Show(middle, view)
ColorBy(shown, ("POINTS", "LTG"))
shown.SetScalarBarVisibility(view, True)

view.ResetCamera()
camera = view.GetActiveCamera()
camera.Elevation(-40)
camera.SetViewUp(0.0, -1.0, 0.0)
view.ResetCamera()
Render(view)
