// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fogbow {

// Metadata that a rendered picture has and others read: floats.

/// Mean luminance, and its standard error: all pixels of a picture by chains share most of it.
inline constexpr const char* kMetadataB = "b";
inline constexpr const char* kMetadataBError = "bStandardError";

}  // namespace fogbow
