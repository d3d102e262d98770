#include "physics/ode_world.h"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <vector>

namespace ukemi {
namespace {

thread_local long failures = 0;  // of ODE on this thread

[[noreturn]] void fail(int, const char* format, va_list arguments) {
  ++failures;
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  throw OdeFailure(text);
}

void ignore_message(int, const char*, va_list) {}

}  // namespace

void initialise_ode() {
  static std::once_flag once;
  std::call_once(once, [] {
    dInitODE2(0);
    dSetErrorHandler(fail);
    dSetDebugHandler(fail);
    dSetMessageHandler(ignore_message);
  });
  dAllocateODEDataForThread(dAllocateMaskAll);
}

OdeWorld::OdeWorld() : failures_before_(failures) {
  initialise_ode();
  world_ = dWorldCreate();
  contacts_ = dJointGroupCreate(0);
  // Worlds that share the default implementation crash when stepped in two threads.
  threading_ = dThreadingAllocateSelfThreadedImplementation();
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_), threading_);
}

bool OdeWorld::poisoned() const { return failures != failures_before_; }

void keep_for_ever(const void* of_ode) {
  static std::mutex mutex;
  static auto* const kept = new std::vector<const void*>;
  const std::lock_guard lock(mutex);
  kept->push_back(of_ode);
}

OdeWorld::~OdeWorld() {
  if (poisoned()) {
    keep_for_ever(contacts_);
    keep_for_ever(world_);
    keep_for_ever(threading_);
    return;
  }
  dJointGroupDestroy(contacts_);
  dWorldDestroy(world_);
  dThreadingFreeImplementation(threading_);
}

void set_quaternion(dBodyID body, const Quat& q) {
  const dQuaternion value = {q.w(), q.x(), q.y(), q.z()};
  dBodySetQuaternion(body, value);
}

}  // namespace ukemi
