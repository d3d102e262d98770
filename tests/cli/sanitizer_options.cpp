// What the program starts with in a sanitized build, whatever environment a test gives it: the leak checker
// crashes in the rasterizer's own threads at exit (Mesa 22.3, LLVM 15).
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }
