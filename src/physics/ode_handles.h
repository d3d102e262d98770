// ODE's opaque handles as <ode/common.h> declares them, so that ODE's headers stay in source files.
#pragma once

typedef struct dxWorld* dWorldID;
typedef struct dxBody* dBodyID;
typedef struct dxGeom* dGeomID;
typedef struct dxJoint* dJointID;
typedef struct dxJointGroup* dJointGroupID;
typedef struct dxThreadingImplementation* dThreadingImplementationID;
