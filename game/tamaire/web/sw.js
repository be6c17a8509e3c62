// Service worker that caches the whole game: it works offline, and a newer version is downloaded in the background.

// Replaced by the build.
const VERSION = "@VERSION@";
const FILES = ["@FILES@"];

const NAME = `tamaire-${VERSION}`;

self.addEventListener("install", (event) => {
  // Files below a content hash never change; others may be outdated in the HTTP cache.
  const requests = FILES.map((file) => new Request(file, { cache: file.startsWith(VERSION) ? "default" : "reload" }));
  event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(requests)));
});

self.addEventListener("message", ({ data }) => {
  if (data === "take over") {
    self.skipWaiting();
  }
});

self.addEventListener("activate", (event) => {
  const others = async () => {
    // Another tab may still use the old version.
    if ((await clients.matchAll({ includeUncontrolled: true })).length > 1) return;
    const names = (await caches.keys()).filter((name) => name.startsWith("tamaire-") && name !== NAME);
    await Promise.all(names.map((name) => caches.delete(name)));
  };
  event.waitUntil(others());
});

self.addEventListener("fetch", (event) => {
  if (event.request.method !== "GET" || new URL(event.request.url).origin !== location.origin) {
    return;
  }
  const answer = async () => {
    const cache = await caches.open(NAME);
    const found = await cache.match(event.request, { ignoreSearch: event.request.mode === "navigate" });
    return found ?? fetch(event.request);
  };
  event.respondWith(answer());
});
