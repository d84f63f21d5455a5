#include "thermal/petsc_session.hpp"

#include <petscsys.h>

#include <array>

#include "thermal/petsc_check.hpp"

namespace layerloop::thermal {

PetscSession::PetscSession() {
  static char program[] = "layerloop", no_handler[] = "-no_signal_handler";
  std::array<char*, 3> words{program, no_handler, nullptr};
  int count = 2;
  char** list = words.data();
  check_petsc(PetscInitialize(&count, &list, nullptr, nullptr));
}

PetscSession::~PetscSession() { PetscFinalize(); }

}  // namespace layerloop::thermal
