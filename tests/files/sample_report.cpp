// Writes the report of a made-up run into the folder named on the command line, for the test that reads it as a browser
// would.
#include "../coupling/sample_run.hpp"
#include "coupling/report.hpp"

int main(int, char** arguments) {
  using namespace layerloop::coupling;
  SampleRun run = sample_run();
  add_pictures(run, arguments[1]);
  write_report(arguments[1], run.checked, run.record, run.bed, run.part, run.extras);
}
