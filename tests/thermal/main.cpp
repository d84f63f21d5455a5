#include <gtest/gtest.h>

#include "thermal/petsc_session.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  layerloop::thermal::PetscSession const petsc;
  return RUN_ALL_TESTS();
}
