// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a program needs to describe a scene, render it and read the pixels.
#include "core/geometry/shapes.h"
#include "core/image/image.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/scene.h"
#include "core/scene/sensors.h"
#include "media/media.h"
#include "mlt/render.h"
