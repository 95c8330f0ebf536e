// Writes the example page, and the figures whose CSV files it must equal, into the folder named.
#include <filesystem>
#include <iostream>
#include <string>

#include "tests/report/example_page.h"

int main(const int n_arguments, char** arguments) {
  if (n_arguments != 3) {
    std::cerr << "usage: example_report FOLDER SAMPLES\n";
    return 2;
  }
  using namespace vibrissa::report;
  const std::filesystem::path folder = arguments[1];
  write_page(folder, testing::example_page(folder, std::stoul(arguments[2])), page_scene);
}
