// The program that draw_pictures() starts in these tests instead of vibrissa.
#include <iostream>
#include <string>

#include "report/pictures.h"

int main(const int n_arguments, char** arguments) {
  if (n_arguments != 3 || std::string(arguments[1]) != "draw") {
    std::cerr << "usage: report_draw_child draw FOLDER\n";
    return 2;
  }
  return vibrissa::report::draw_folder(arguments[2]);
}
