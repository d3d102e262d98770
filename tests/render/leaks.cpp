// Leaks of the software rasterizer itself, for builds with LeakSanitizer.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa\nleak:libEGL_mesa\n"; }
