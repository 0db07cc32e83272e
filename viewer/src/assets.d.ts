declare module "*.inc" {
  const text: string;
  export default text;
}
/** A module bundled for a worker, as text. */
declare module "worker:*" {
  const text: string;
  export default text;
}
