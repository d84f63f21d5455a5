#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>  // cross products

namespace layerloop {
/// Position [m], velocity [m/s] or direction in the machine frame: x along the recoating direction, z up.
using Vec3 = Eigen::Vector3d;
}  // namespace layerloop
