#pragma once
#include <petscsys.h>

#include <stdexcept>
#include <string>

namespace layerloop::thermal {

/// \throws std::runtime_error when a PETSc call failed (PETSc has then printed its own trace)
inline void check_petsc(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error("PETSc call failed with code " + std::to_string(static_cast<int>(code)));
}

}  // namespace layerloop::thermal
