/// For the leak check of the sanitize preset: VTK 9.1 loses one byte per surface that it extracts.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:vtkGeometryFilterHelper\n";
}
