#pragma once
#include <string>

namespace layerloop {

/// A track on a plate, melted in a blink. [heat] stands last, so that a test may go on with it.
inline std::string const plate_track = R"([powder]
material = "316L"
[laser]
power = "60 W"
absorptivity = 0.3
wavelength = "1070 nm"
spot_diameter = "60 um"
spot_definition = "1/e2"
[scan]
kind = "track"
scan_speed = "0.5 m/s"
track_length = "250 um"
[heat]
cell_size = "7.5 um"
size = ["450 um", "210 um", "90 um"]
)";

}  // namespace layerloop
