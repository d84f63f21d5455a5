#pragma once

namespace layerloop::thermal {

/// PETSc for as long as it lives. Starts MPI when nobody has, and then also ends it.
/// PETSc installs no signal handlers, so that an interrupted run can still write its checkpoint.
/// \note Collective over MPI_COMM_WORLD. Options (`-heat_snes_monitor`, ...) come from PETSC_OPTIONS.
class PetscSession {
 public:
  PetscSession();
  ~PetscSession();
  PetscSession(PetscSession const&) = delete;
  PetscSession& operator=(PetscSession const&) = delete;
};

}  // namespace layerloop::thermal
