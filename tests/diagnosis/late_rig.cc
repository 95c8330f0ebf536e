// late_rig FOLDER: writes sim/ and real/ of a rig whose bench is 4 ms late, for tests of other
// rooms.
#include "tests/diagnosis/rig_folder.h"

int main(int, char** argv) {
  vibrissa::diagnosis::test::write_late_rig(argv[1]);
}
