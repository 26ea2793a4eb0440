// How finely the 3-D view is drawn.

/// Whether the processor itself draws the pictures, because there is no graphics processor. Every triangle then costs
/// about a microsecond, so the view has fewer of them, and neither shadows nor smooth edges.
/// `?fine` in the address asks for the finest picture in any case, for example for a screenshot.
export const simple = !new URLSearchParams(location.search).has("fine") && !hasGraphicsProcessor();

/// Number of sides of round shapes.
export const AROUND = simple ? 12 : 28;
/// Number of rings of a hemisphere.
export const RINGS = simple ? 3 : 8;

function hasGraphicsProcessor() {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) return false;
  const details = probe.getExtension("WEBGL_debug_renderer_info");
  const renderer = probe.getParameter(details?.UNMASKED_RENDERER_WEBGL ?? probe.RENDERER);
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return !/swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer);
}
