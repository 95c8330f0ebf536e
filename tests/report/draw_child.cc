// The program that draw_pictures() starts in these tests instead of vibrissa.
#include <iostream>
#include <string>

#include "report/modes/draw_scenes.h"

int main(const int n_arguments, char** arguments) {
  if (n_arguments != 4 || std::string(arguments[1]) != "draw" ||
      std::string(arguments[3]) != "--scenes") {
    std::cerr << "usage: report_draw_child draw FOLDER --scenes\n";
    return 2;
  }
  return vibrissa::report::draw_scenes(arguments[2]) ? 0 : 1;
}
